#include "firmware/safety/supply.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::firmware;
using control::fault::kBrownOut;
using safety::SupplyWatch;

TEST_CASE("Two low ticks in a row are a brown-out, one is a spike") {
  SupplyWatch watch;
  CHECK(watch.note(false, 48.0f) == 0);
  for (int i = 0; i < 5; ++i) {
    CHECK(watch.note(true, 48.0f) == 0);
    CHECK(watch.note(false, 48.0f) == 0);
  }
  CHECK(watch.note(true, 48.0f) == 0);
  CHECK(watch.note(true, 48.0f) == kBrownOut);
  CHECK(watch.note(true, 48.0f) == kBrownOut);
  CHECK(watch.note(false, 48.0f) == 0);
  CHECK(watch.note(true, 48.0f) == 0);
}

TEST_CASE("A measured supply below 36 V counts as low, 0 is one that is not measured") {
  const auto second_tick = [](float supply_V) {
    SupplyWatch watch;
    watch.note(false, supply_V);
    return watch.note(false, supply_V);
  };
  CHECK(second_tick(36.0f) == 0);
  CHECK(second_tick(std::nextafter(36.0f, 0.0f)) == kBrownOut);
  CHECK(second_tick(0.0f) == 0);
  CHECK(second_tick(1e-3f) == kBrownOut);
  CHECK(second_tick(-1.0f) == kBrownOut);
  CHECK(second_tick(std::nanf("")) == kBrownOut);  // a measurement that is none
  SupplyWatch watch;  // either sign of it, in turn, is still two in a row
  CHECK(watch.note(true, 0.0f) == 0);
  CHECK(watch.note(false, 20.0f) == kBrownOut);
}
