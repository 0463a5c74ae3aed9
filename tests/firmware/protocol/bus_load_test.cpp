#include "firmware/protocol/bus_load.h"

#include <catch2/catch.hpp>

using namespace hoof::firmware::protocol;

TEST_CASE("Worst-case load of both buses stays below the gate, counted by hand") {
  // 8 bytes: 34 + 64 + 24 + 13 = 135 bits; 4 bytes: 34 + 32 + 16 + 13 = 95; 3 bytes: 85.
  // Bus 0, per ms: SYNC, command, reply; per 2 ms, as in a firmware update: write, answer; per 10
  // ms: e-stop, order, acknowledge, connect, request, heartbeat, five telemetry frames; per 100 ms:
  // two of counters.
  const double bus0 =
      (95 + 2 * 135) * 1000.0 + 2 * 135 * 500.0 + (85 + 10 * 135) * 100.0 + 2 * 135 * 10.0;
  const double bus1 = (95 + 4 * 135) * 1000.0;
  CHECK(worst_load_ratio(kBus0) == Approx(bus0 / 1e6).epsilon(1e-12));  // sums of whole numbers
  CHECK(worst_load_ratio(kBus1) == Approx(bus1 / 1e6).epsilon(1e-12));
  CHECK(worst_load_ratio(kBus0) <= 0.70);
  CHECK(worst_load_ratio(kBus1) <= 0.70);
}

TEST_CASE("One bus for all drives would be too full: the reason for two") {
  CHECK(worst_load_ratio(kBus0) + worst_load_ratio(kBus1) - 0.095 > kLargestLoad_ratio);
}
