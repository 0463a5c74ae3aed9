#include "firmware/safety/board_heat.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::firmware;
using control::fault::kOverTemperature;
using safety::BoardHeatWatch;

TEST_CASE("Two hot ticks in a row are an over-temperature, one is a disturbance") {
  BoardHeatWatch watch;
  for (int i = 0; i < 5; ++i) {
    CHECK(watch.note(120.0f) == 0);
    CHECK(watch.note(60.0f) == 0);
  }
  CHECK(watch.note(120.0f) == 0);
  CHECK(watch.note(120.0f) == kOverTemperature);
  CHECK(watch.note(120.0f) == kOverTemperature);
  CHECK(watch.note(60.0f) == 0);
  CHECK(watch.note(120.0f) == 0);
}

TEST_CASE("A board is hot above 100 C, and not where nobody measures it") {
  const auto second_tick = [](float temperature_C) {
    BoardHeatWatch watch;
    watch.note(temperature_C);
    return watch.note(temperature_C);
  };
  CHECK(second_tick(100.0f) == 0);
  CHECK(second_tick(std::nextafter(100.0f, 200.0f)) == kOverTemperature);
  CHECK(second_tick(-40.0f) == 0);
  CHECK(second_tick(std::nanf("")) == 0);
}
