#include "hal/in_process/load_meter.h"

#include <catch2/catch.hpp>

#include "tests/hal/in_process/bus_fixture.h"

namespace hoof::hal {

TEST_CASE("worst window: intervals are cut at its borders", "[load_meter]") {
  WindowLoad load(1'000);
  CHECK(load.worst_ratio() == 0.0);
  load.add(100, 300);
  CHECK(load.worst_ratio() == Approx(0.2));
  load.add(900, 1'300);  // 100 here, 300 in the next
  CHECK(load.worst_ratio() == Approx(0.3));
  load.add(1'500, 1'600);
  CHECK(load.worst_ratio() == Approx(0.4));
  load.add(5'000, 5'100);  // a quiet one changes nothing
  CHECK(load.worst_ratio() == Approx(0.4));
  load.add(6'500, 9'000);  // longer than a window
  CHECK(load.worst_ratio() == Approx(1.0));
}

TEST_CASE("mean load counts what has passed of the present frame", "[load_meter]") {
  LoadMeter load;
  CHECK(load.mean_ratio(0) == 0.0);
  load.add(0, 100'000);
  CHECK(load.mean_ratio(50'000) == Approx(1.0));
  CHECK(load.mean_ratio(100'000) == Approx(1.0));
  CHECK(load.mean_ratio(400'000) == Approx(0.25));
}

TEST_CASE("a bus with a known plan has the load worked out by hand", "[load_meter]") {
  // Identifier 0 without data is 53 bits (can_timing_test): 3 of them in each 1 ms tick, and in the
  // fifth tick of ten two more.
  InProcessBus bus({});
  InProcessPort& port = bus.attach("port");
  for (int tick = 0; tick < 20; ++tick) {
    for (int i = 0; i < 3; ++i) port.send(test::frame(0));
    bus.advance_to(tick * 1'000'000 + 500'000);
    for (int i = 0; tick % 10 == 4 && i < 2; ++i) port.send(test::frame(0));
    bus.advance_to((tick + 1) * 1'000'000);
  }
  CHECK(bus.mean_load_ratio() == Approx(0.0053 * (30 + 2)));
  CHECK(bus.load().worst_1ms_ratio() == Approx(0.053 * 5));
  CHECK(bus.load().worst_10ms_ratio() == Approx(0.0053 * 32));
}

}  // namespace hoof::hal
