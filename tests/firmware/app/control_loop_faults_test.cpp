// Every fault of the table in firmware/README.md that the loop can meet: trigger, reaction, way
// out.
#include <catch2/catch.hpp>
#include <random>

#include "tests/firmware/app/loop_bench.h"

using namespace hoof::firmware;
using app::test::LoopBench;
using app::test::TestDrive;
using control::Mode;
using protocol::Order;
using protocol::OrderResult;
namespace fault = control::fault;

namespace {

void bring_to_running(LoopBench& bench) {
  bench.run(5);
  REQUIRE(bench.order(Order::kRun, 0.3f, 1.0f) == OrderResult::kAccepted);
  REQUIRE(bench.run_until(Mode::kRunning) > 0);
  bench.run(300);
  REQUIRE(bench.loop->faults() == 0);
}

/// Damping only, on every drive. No feed-forward either, unless a joint moves so fast that the gate
/// cuts the damping itself.
void check_damping(const LoopBench& bench) {
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    const protocol::DriveOrder& last = bench.drives[i]->last;
    CHECK_FALSE(last.action.has_value());
    CHECK(last.command.kp_Nm_rad == 0.0f);
    CHECK(last.command.kd_Nm_s_rad > 0.0f);
    const bool cut = bench.loop->telemetry().verdict.limits[i] == safety::limit::kTorque;
    CHECK((cut || std::abs(last.command.torque_Nm) < 0.1f));  // half a code
  }
}

void check_latched_until_reset(LoopBench& bench) {
  CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kWrongMode);
  CHECK(bench.order(Order::kReset) == OrderResult::kAccepted);
  CHECK(bench.loop->mode() == Mode::kOff);
  CHECK(bench.loop->faults() == 0);
  CHECK(bench.order(Order::kReady, 0.1f) == OrderResult::kAccepted);
  CHECK(bench.run_until(Mode::kReady) > 0);
}

}  // namespace

TEST_CASE("SYNC lost: after 20 ms of the local clock damped stop by the local clock, then fault") {
  LoopBench bench;
  bring_to_running(bench);
  bench.sync = false;
  bench.run(19);
  CHECK(bench.loop->mode() == Mode::kRunning);
  bench.run(2);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
  CHECK(bench.loop->faults() == fault::kSyncLost);
  const int before = bench.hip.commands;
  bench.run(50);
  CHECK(bench.hip.commands == Approx(before + 50).margin(2));  // a command per millisecond
  check_damping(bench);
  REQUIRE(bench.run_until(Mode::kFault, 3000) > 0);
  CHECK(bench.drives_free());
  CHECK(bench.heartbeats.back().faults == fault::kSyncLost);
  bench.sync = true;
  bench.run(50);
  CHECK(bench.loop->mode() == Mode::kFault);
  check_latched_until_reset(bench);
}

TEST_CASE("SYNC may pause for less than 20 ms, again and again") {
  LoopBench bench;
  bring_to_running(bench);
  for (int i = 0; i < 10; ++i) {
    bench.sync = false;
    bench.run(18);
    bench.sync = true;
    bench.run(5);
  }
  CHECK(bench.loop->mode() == Mode::kRunning);
}

TEST_CASE("A loop that was not called for 21 ms does not trust what waited meanwhile") {
  LoopBench bench;
  bring_to_running(bench);
  bench.polled = false;
  bench.run(22);
  bench.polled = true;
  bench.run(1);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
  CHECK((bench.loop->faults() & fault::kSyncLost) != 0);
}

TEST_CASE("A drive lost: damped stop within 22 ms, for each drive") {
  for (int i = 0; i < 3; ++i) {
    LoopBench bench;
    bring_to_running(bench);
    bench.drives[i]->silent = true;
    bench.run(19);
    CHECK(bench.loop->mode() == Mode::kRunning);
    bench.run(3);
    CHECK(bench.loop->mode() == Mode::kDampedStop);
    CHECK(bench.loop->faults() == fault::kDriveLost);
    REQUIRE(bench.run_until(Mode::kFault, 3000) > 0);
    bench.drives[i]->silent = false;
    bench.run(2);
    CHECK(bench.drives_free());
    check_latched_until_reset(bench);  // homes anew
  }
}

TEST_CASE("A drive that is not there is found missing when homing begins") {
  LoopBench bench;
  bench.knee.silent = true;
  bench.run(50);
  CHECK(bench.loop->faults() == 0);  // nothing is expected while off
  bench.order(Order::kReady, 0.1f);
  bench.run(30);
  CHECK(bench.loop->faults() == fault::kDriveLost);
}

TEST_CASE("The e-stop frame takes the torque away within a millisecond, whatever it carries") {
  for (const int length : {1, 0, 8}) {
    LoopBench bench;
    bring_to_running(bench);
    hoof::hal::CanFrame frame;
    frame.id = 0x001;
    frame.length = static_cast<std::uint8_t>(length);
    bench.supervisor.send(frame);
    bench.sync = false;  // not even SYNC is needed
    bench.run(1);
    CHECK(bench.loop->mode() == Mode::kEmergencyOff);
    CHECK(bench.loop->faults() == fault::kEmergencyStop);
    CHECK(bench.drives_free());
    bench.sync = true;
    bench.run(100);
    CHECK(bench.drives_free());
    check_latched_until_reset(bench);
  }
}

TEST_CASE("A drive's own error, heat and a jump of its angle each stop the foot") {
  struct Case {
    void (*spoil)(TestDrive&);
    control::FaultBits bits;
  };
  const Case cases[] = {
      {[](TestDrive& d) { d.error = 6; }, fault::kDriveError},
      {[](TestDrive& d) { d.temperature_C = 120.0f; }, fault::kOverTemperature},
      {[](TestDrive& d) { d.zero_rad += 0.15; }, fault::kImplausibleReply},
  };
  for (const Case& c : cases) {
    for (int i = 0; i < 3; ++i) {
      LoopBench bench;
      bring_to_running(bench);
      c.spoil(*bench.drives[i]);
      bench.run(3);
      CHECK(bench.loop->mode() == Mode::kDampedStop);
      CHECK(bench.loop->faults() == c.bits);
      check_damping(bench);
    }
  }
}

TEST_CASE("Toes forced beyond their travel stop the foot, once their zero is known") {
  LoopBench bench;
  bring_to_running(bench);
  bench.toe.plant.load_Nm = 14.0;  // the gate lets the drive resist with 10
  REQUIRE(bench.run_until(Mode::kDampedStop, 500) > 0);
  CHECK(bench.loop->faults() == fault::kOutsideTravel);
  CHECK(bench.loop->telemetry().state[0].position_rad > 1.05f);
}

TEST_CASE("Bus off is a fault") {
  LoopBench bench;
  bring_to_running(bench);
  bench.foot1.set_bus_off(true);
  bench.run(2);
  CHECK((bench.loop->faults() & fault::kBusOff) != 0);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
}

TEST_CASE("A bus 0 that is off is told at once, though no SYNC can come, and in mode off, too") {
  for (const bool running : {true, false}) {
    CAPTURE(running);
    LoopBench bench;
    if (running) bring_to_running(bench);
    if (!running) bench.run(100);
    bench.foot0.set_bus_off(true);
    bench.run(2);
    CHECK(bench.loop->faults() == fault::kBusOff);
    CHECK(bench.loop->mode() == (running ? Mode::kDampedStop : Mode::kFault));
  }
}

TEST_CASE("Repeated and older SYNC numbers run no tick; gaps are counted") {
  LoopBench bench;
  bench.run(100);
  const std::uint32_t ticks = bench.loop->telemetry().counters.ticks;
  for (const std::uint32_t number : {bench.tick - 1, bench.tick - 50, 0u}) {
    bench.sync = false;
    bench.master0.send(encode(protocol::Sync{number}));
    bench.run(1);
  }
  bench.sync = true;
  bench.tick += 7;
  bench.run(1);
  CHECK(bench.loop->telemetry().counters.ticks == ticks + 1);
  CHECK(bench.loop->telemetry().counters.stale_syncs == 3);
  CHECK(bench.loop->telemetry().counters.missed_ticks == 7);
}

TEST_CASE("A SYNC master that starts anew is followed after a pause") {
  LoopBench bench;
  bench.run(100);
  bench.sync = false;
  bench.run(30);
  bench.sync = true;
  bench.tick = 0;
  const std::uint32_t ticks = bench.loop->telemetry().counters.ticks;
  bench.run(10);
  CHECK(bench.loop->telemetry().counters.ticks == ticks + 10);
}

TEST_CASE("A flood of unknown, short, long and odd frames is counted and harmless") {
  const unsigned seed = 41;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  LoopBench bench;
  hoof::hal::InProcessPort& rogue = bench.bus0.attach("rogue");
  bring_to_running(bench);
  std::uint32_t sent = 0;
  for (int n = 0; n < 1500; ++n) {
    hoof::hal::CanFrame frame;
    frame.id = random() % 0x800;
    if (frame.id == 0x001) continue;  // would rightly stop it
    frame.extended = random() % 8 == 0;
    frame.length = static_cast<std::uint8_t>(random() % 9);
    for (auto& byte : frame.data) byte = static_cast<std::uint8_t>(random());
    // A well-formed SYNC or reply of the right length is no odd frame.
    const bool real = !frame.extended && ((frame.id == 0x010 && frame.length == 4) ||
                                          (frame.id == 0x031 && frame.length == 8) ||
                                          (frame.id >= 0x021 && frame.id <= 0x023));
    if (real) continue;
    sent += rogue.send(frame) == hoof::hal::SendResult::kQueued;
    bench.millisecond();
  }
  CHECK(sent > 1000);
  CHECK(bench.loop->mode() == Mode::kRunning);
  CHECK(bench.loop->faults() == 0);
  CHECK(bench.loop->telemetry().counters.bad_frames() + 1 >= sent);
}

TEST_CASE("Orders with a bad CRC, an old counter or from another supervisor do nothing") {
  LoopBench bench;
  bring_to_running(bench);
  // Bad CRC.
  auto frame = encode(protocol::SupervisorOrder{1, Order::kStop, 0, 0, bench.counter});
  frame.data[7] ^= 0x10;
  bench.supervisor.send(frame);
  bench.run(2);
  CHECK(bench.answers.back().result == OrderResult::kBadCrc);
  // The last order once more, and one that is ahead.
  const std::uint8_t right = bench.counter;
  for (const int offset : {-1, 1, 100}) {
    bench.counter = static_cast<std::uint8_t>(right + offset);
    CHECK(bench.order(Order::kStop) == OrderResult::kBadCounter);
    CHECK(bench.counter == right);  // the answer tells the right one
  }
  CHECK(bench.order(Order::kReady, 0.1f, 0.0f, 2) == OrderResult::kNotOwner);
  CHECK(bench.order(Order::kReady, 0.1f, 0.0f, 0) == OrderResult::kNotConnected);
  CHECK(bench.order(Order::kReady, 0.96f) == OrderResult::kOutOfRange);
  CHECK(bench.loop->mode() == Mode::kRunning);
  bench.run(1);
  CHECK(bench.loop->telemetry().counters.refused_orders == 8);  // the connection of number 0, too
  // But anybody may stop.
  CHECK(bench.order(Order::kStop, 0.0f, 0.0f, 2) == OrderResult::kAccepted);
  CHECK(bench.loop->mode() == Mode::kDampedStop);
}

TEST_CASE("Ended from this side: leg let down, drives left") {
  LoopBench bench;
  bring_to_running(bench);
  bench.loop->request_stop();
  bench.run(1);
  check_damping(bench);
  REQUIRE(bench.run_until(Mode::kOff) > 0);
  bench.loop->release_drives();
  bench.run(1);
  CHECK(bench.drives_free());
}
