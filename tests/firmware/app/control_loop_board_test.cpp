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

TEST_CASE(
    "A reset by the watchdog, a crash or the supply is told and moves nothing until acknowledged") {
  for (const auto& [cause, bits] :
       {std::pair{hoof::hal::ResetCause::kWatchdog, fault::kUnexpectedReset},
        std::pair{hoof::hal::ResetCause::kSoftware, fault::kUnexpectedReset},
        std::pair{hoof::hal::ResetCause::kBrownOut, fault::kBrownOut}}) {
    LoopBench bench(calibrated(), nullptr, cause);
    bench.run(15);
    CHECK(bench.loop->mode() == Mode::kFault);
    CHECK(bench.heartbeats.back().faults == bits);
    CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kWrongMode);
    CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
    CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
  }
  for (const auto cause : {hoof::hal::ResetCause::kPowerOn, hoof::hal::ResetCause::kPin}) {
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

TEST_CASE("The watchdog is fed by every finished cycle, and by nothing else") {
  LoopBench bench;
  bench.run(10);
  const std::uint32_t idle = bench.board.feeds;
  CHECK(idle == 200);  // 20 polls a millisecond, with and without a tick due
  bring_to_ready(bench);
  const std::uint32_t before = bench.board.feeds;
  bench.run(10);
  CHECK(bench.board.feeds == before + 200);
  bench.polled = false;  // the loop hangs
  bench.run(10);
  CHECK(bench.board.feeds == before + 200);
}

TEST_CASE("A supply that sags stops the foot; a spike of one tick does not") {
  LoopBench bench;
  bring_to_ready(bench);
  bench.board.low = true;
  bench.run(1);
  bench.board.low = false;
  bench.run(5);
  CHECK(bench.loop->faults() == 0);
  bench.board.low = true;
  bench.run(3);
  CHECK(bench.loop->faults() == fault::kBrownOut);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
  CHECK_FALSE(bench.loop->telemetry().homed);  // the toe drive may have lost its count
  LoopBench measured;
  measured.board.volts = 48.0f;
  bring_to_ready(measured);
  CHECK(measured.loop->telemetry().supply_V == 48.0f);
  measured.board.volts = 35.0f;
  measured.run(3);
  CHECK(measured.loop->faults() == fault::kBrownOut);
}

TEST_CASE("A hot processor stops the foot") {
  LoopBench bench;
  bench.board.celsius = 99.0f;
  bring_to_ready(bench);
  bench.board.celsius = 101.0f;
  bench.run(3);
  CHECK(bench.loop->faults() == fault::kOverTemperature);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
}

TEST_CASE("Drives are allowed to brake in a stop, and nothing behind it until the reset") {
  LoopBench bench;
  CHECK_FALSE(bench.board.drives_allowed);
  bring_to_ready(bench);
  CHECK(bench.board.drives_allowed);
  bench.board.celsius = 101.0f;
  bench.run(3);
  REQUIRE(bench.loop->mode() == Mode::kDampedStop);
  CHECK(bench.board.drives_allowed);
  REQUIRE(bench.run_until(Mode::kFault) > 0);
  bench.run(1);
  CHECK_FALSE(bench.board.drives_allowed);
  bench.board.celsius = 40.0f;
  CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
  bench.run(1);
  CHECK(bench.board.drives_allowed);
  bench.board.pressed = true;
  bench.run(1);
  CHECK_FALSE(bench.board.drives_allowed);
  bench.board.pressed = false;
  bench.run(10);
  CHECK_FALSE(bench.board.drives_allowed);  // released is not reset
  CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
  bench.run(1);
  CHECK(bench.board.drives_allowed);
}

namespace {

/// Each look at it takes time: a tick that ends later than it began by two of these.
class SlowClock final : public hoof::hal::Clock {
 public:
  std::int64_t step_ns = 0;
  mutable std::int64_t now = 0;
  std::int64_t now_ns() const override { return now += step_ns; }
};

}  // namespace

TEST_CASE("Ticks that take longer than a tick are counted; three in a row stop the foot") {
  LoopBench bench;
  SlowClock clock;
  auto parameters = calibrated();
  app::ControlLoop loop({&bench.foot0, &bench.foot1}, clock, bench.board, parameters);
  std::uint32_t tick = 0;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      bench.master0.send(encode(protocol::Sync{tick++}));
      bench.bus0.advance_to(bench.bus0.now_ns() + 1'000'000);
      bench.bus1.advance_to(bench.bus1.now_ns() + 1'000'000);
      loop.poll();
    }
  };
  clock.step_ns = 500'000;
  run(10);
  CHECK(loop.telemetry().counters.overruns == 0);
  clock.step_ns = 1'100'000;
  run(2);
  clock.step_ns = 500'000;
  run(2);
  CHECK(loop.telemetry().counters.overruns == 2);
  CHECK(loop.faults() == 0);
  clock.step_ns = 1'100'000;
  run(4);
  CHECK(loop.faults() == fault::kOverrun);
}
