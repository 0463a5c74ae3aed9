// The loop and its board: e-stop line, watchdog, supply, start after a reset.
#include <catch2/catch.hpp>

#include "tests/firmware/app/loop_bench.h"

using namespace hoof::firmware;
using app::test::calibrated;
using app::test::LoopBench;
using control::Mode;
using protocol::Order;
using protocol::OrderResult;
namespace fault = control::fault;

namespace {

void bring_to_ready(LoopBench& bench) {
  bench.run(5);
  REQUIRE(bench.order(Order::kReady, 0.3f) == OrderResult::kAccepted);
  REQUIRE(bench.run_until(Mode::kReady) > 0);
  bench.run(100);
  REQUIRE(bench.loop->faults() == 0);
}

}  // namespace

TEST_CASE("The e-stop line takes the torque away at once and keeps it away while it is open") {
  LoopBench bench;
  bring_to_ready(bench);
  bench.board.pressed = true;
  bench.sync = false;  // not even SYNC is needed
  bench.run(1);
  CHECK(bench.loop->mode() == Mode::kEmergencyOff);
  CHECK(bench.loop->faults() == fault::kEmergencyStop);
  CHECK(bench.drives_free());
  const int exits = bench.hip.commands;
  bench.run(50);
  CHECK(bench.hip.commands == exits);  // the line is no flood of frames
  bench.sync = true;
  CHECK(bench.order(Order::kReset) == OrderResult::kWrongMode);
  CHECK(bench.loop->mode() == Mode::kEmergencyOff);
  bench.board.pressed = false;
  bench.run(100);
  CHECK(bench.loop->mode() == Mode::kEmergencyOff);  // released is not reset
  CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
  CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
}

TEST_CASE("A foot that starts with the line open stays off") {
  LoopBench bench;
  bench.board.pressed = true;
  bench.run(5);
  CHECK(bench.loop->mode() == Mode::kEmergencyOff);
  CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kWrongMode);
}

TEST_CASE("Exit frames of an e-stop that the bus refuses go out as soon as it takes them") {
  LoopBench bench;
  bring_to_ready(bench);
  bench.sync = false;
  bench.foot1.set_bus_off(true);
  bench.board.pressed = true;
  bench.run(3);
  CHECK(bench.hip.entered);  // it could not be told
  bench.foot1.set_bus_off(false);
  bench.run(1);
  CHECK_FALSE(bench.hip.entered);
  CHECK_FALSE(bench.knee.entered);
}

TEST_CASE("A reset by the watchdog or by the supply is told and moves nothing until acknowledged") {
  for (const auto& [cause, bits] :
       {std::pair{hoof::hal::ResetCause::kWatchdog, fault::kWatchdogReset},
        std::pair{hoof::hal::ResetCause::kBrownOut, fault::kBrownOut}}) {
    LoopBench bench(calibrated(), nullptr, cause);
    bench.run(15);
    CHECK(bench.loop->mode() == Mode::kFault);
    CHECK(bench.heartbeats.back().faults == bits);
    CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kWrongMode);
    CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
    CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
  }
  for (const auto cause : {hoof::hal::ResetCause::kPowerOn, hoof::hal::ResetCause::kPin,
                           hoof::hal::ResetCause::kSoftware}) {
    LoopBench bench(calibrated(), nullptr, cause);
    bench.run(5);
    CHECK(bench.loop->mode() == Mode::kOff);
  }
}

TEST_CASE("An order that comes without SYNC is refused: nothing moves when SYNC comes later") {
  LoopBench bench;
  bench.run(50);
  bench.sync = false;
  bench.run(30);
  CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kNoSync);
  bench.sync = true;
  bench.run(100);
  CHECK(bench.loop->mode() == Mode::kOff);
}
