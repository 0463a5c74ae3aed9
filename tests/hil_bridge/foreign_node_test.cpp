// Strangers on the bus, at its real bit timing: no joint moves because of them, and what is lost is
// counted.

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "firmware/protocol/codec.h"
#include "hil_bridge/effects/faulty_wires.h"
#include "hil_bridge/reaction.h"
#include "tests/hil_bridge/rigid_bench.h"

using namespace hoof;
using bridge::LockStep;
using firmware::protocol::Mode;
using firmware::protocol::Order;
namespace protocol = firmware::protocol;

namespace {

constexpr double kToe_rad = 0.35;

/// The leg rig, and one more node on each bus.
struct Bench {
  tools::RunSettings run = test::rigid_run("traction");
  std::unique_ptr<sim::Experiment> experiment = test::rigid_bench(run);
  std::unique_ptr<bridge::Wires> wires = bridge::in_process_wires({});
  bridge::FaultyWires faulty{*wires};  // whose SYNC master bears a bus that takes nothing
  LockStep lock_step{*experiment, run.parameters, faulty};
  std::array<hal::CanBus*, 2> stranger{&wires->attach(0, "stranger"),
                                       &wires->attach(1, "stranger")};
  std::uint64_t sent = 0;
  int tick = 0;

  using Talk = std::function<void(Bench&)>;

  void go(int ticks, const Talk& talk = {}) {
    for (int i = 0; i < ticks; ++i, ++tick) {
      if (talk) talk(*this);
      lock_step.tick();
      hal::CanFrame heard;
      for (hal::CanBus* bus : stranger) {
        while (bus->receive(heard)) {
        }
      }
    }
  }

  /// As often as its mailboxes take it.
  void flood(int bus, const std::function<hal::CanFrame()>& frame) {
    while (stranger[std::size_t(bus)]->send(frame()) == hal::SendResult::kQueued) ++sent;
  }

  void make_ready() {
    lock_step.supervisor().order(Order::kReady, kToe_rad);
    for (int i = 0; i < 8000 && !still(); ++i) go(1);
    REQUIRE(still());
    go(300);
  }

  bool still() const {
    const auto& t = lock_step.firmware().telemetry();
    return t.mode == firmware::control::Mode::kReady && !t.toe_moving;
  }

  std::array<double, 3> joints() const {
    const sim::Rig& rig = experiment->plant().rig();
    return {rig.joint_position_rad(sim::Joint::kToe), rig.joint_position_rad(sim::Joint::kHip),
            rig.joint_position_rad(sim::Joint::kKnee)};
  }

  const firmware::app::Counters& counters() const {
    return lock_step.firmware().telemetry().counters;
  }
};

/// Largest distance of a joint between a run with the stranger and one without.
double moved_rad(bool ready, int ticks, const Bench::Talk& talk, Bench& with) {
  Bench without;
  if (ready) without.make_ready(), with.make_ready();
  double most = 0;
  for (int i = 0; i < ticks; ++i) {
    without.go(1), with.go(1, talk);
    const auto a = without.joints(), b = with.joints();
    for (std::size_t j = 0; j < 3; ++j) most = std::max(most, std::abs(a[j] - b[j]));
  }
  return most;
}

/// As cangen makes them: any identifier, length and data, standard and extended, remote too.
struct AnyFrame {
  std::mt19937 random{7};

  hal::CanFrame operator()() {
    hal::CanFrame frame;
    frame.extended = random() % 2 == 0;
    frame.id = random() & (frame.extended ? 0x1FFF'FFFFu : 0x7FFu);
    frame.remote = random() % 8 == 0;
    frame.length = std::uint8_t(random() % 9);
    for (int i = 0; i < frame.length; ++i) frame.data[std::size_t(i)] = std::uint8_t(random());
    return frame;
  }
};

bool in_dictionary(const hal::CanFrame& frame) {
  for (const protocol::MessageSpec& message : protocol::kMessages) {
    if (message.id == frame.id && !frame.extended) return true;
  }
  return false;
}

hal::CanFrame unknown(std::uint32_t id) {
  hal::CanFrame frame;
  frame.id = id;
  frame.length = 8;
  return frame;
}

// A held joint gives way by less than a code of its encoder (0.4 mrad on the wire) to what other
// frame times change in the phase of commands.
constexpr double kStill_rad = 5e-4;

}  // namespace

TEST_CASE("foreign: any frames at full rate on both buses move no joint of a foot that is off") {
  Bench bench;
  AnyFrame any;
  const double moved = moved_rad(
      false, 1000,
      [&](Bench& b) {
        b.flood(0, any);
        b.flood(1, any);
      },
      bench);
  CHECK(moved < 1e-9);
  CHECK(bench.sent > 3000);
  CHECK(bench.counters().bad_frames() > 1000);
}

TEST_CASE("foreign: unknown frames behind all others at full rate leave a foot at work alone") {
  Bench bench;
  const double moved = moved_rad(
      true, 500,
      [](Bench& b) {
        for (int bus = 0; bus < 2; ++bus) b.flood(bus, [] { return unknown(0x7FF); });
      },
      bench);
  CHECK(moved < kStill_rad);
  CHECK(bench.still());
  CHECK(bench.lock_step.firmware().faults() == 0);
  bench.go(5);
  CHECK(bench.counters().unknown_frames == bench.sent);  // every single one
}

TEST_CASE("foreign: any frames but the dictionary's at full rate: held, or stopped, and counted") {
  Bench bench;
  AnyFrame any;
  const auto talk = [&any](Bench& b) {
    for (int bus = 0; bus < 2; ++bus) {
      b.flood(bus, [&any] {
        hal::CanFrame frame = any();
        while (in_dictionary(frame)) frame = any();
        return frame;
      });
    }
  };
  const double moved = moved_rad(true, 500, talk, bench);
  CHECK(moved < kStill_rad);
  bench.go(5);
  CHECK(bench.counters().unknown_frames == bench.sent);
}

// Equal identifiers at one instant destroy each other until a node leaves the bus, ours perhaps:
// then SYNC is lost.
TEST_CASE(
    "foreign: a second SYNC master, with old or wild numbers: held or let down, never pushed") {
  for (const bool wild : {false, true}) {
    CAPTURE(wild);
    Bench bench;
    bench.make_ready();
    const auto before = bench.joints();
    std::mt19937 random(3);
    for (int i = 0; i < 300; ++i) {
      const std::uint32_t number = wild ? std::uint32_t(random()) : std::uint32_t(bench.tick / 2);
      bench.go(1, [&](Bench& b) { b.stranger[0]->send(encode(protocol::Sync{number})); });
    }
    const std::uint32_t faults = bench.lock_step.firmware().faults();
    CHECK((faults & ~firmware::control::fault::kSyncLost) == 0);
    CHECK((bench.still() || bridge::all_passive(bench.experiment->plant())));
    CHECK(bench.counters().stale_syncs + bench.counters().missed_ticks + bench.faulty.lost_syncs() >
          0);
    // Let down from its posture in the air by its own weight, at most.
    const auto after = bench.joints();
    for (std::size_t j = 0; j < 3; ++j) CHECK(std::abs(after[j] - before[j]) < 0.3);
  }
}

TEST_CASE("foreign: an FD frame cannot be sent on a classic bus") {
  Bench bench;
  hal::CanFrame frame = unknown(0x021);
  frame.fd = true;
  frame.length = 64;
  bench.go(10);
  const auto frames = bench.wires->frames();
  CHECK(bench.stranger[0]->send(frame) == hal::SendResult::kInvalid);
  Bench alone;
  alone.go(11);
  bench.go(1);
  CHECK(bench.wires->frames() == alone.wires->frames());
  CHECK(bench.wires->frames() > frames);
}

TEST_CASE("foreign: a second supervisor is refused, whatever it orders, but for the stop") {
  Bench bench;
  bridge::Supervisor second(bench.wires->attach(0, "second"), 9);
  bench.make_ready();
  const auto before = bench.joints();
  const auto refused = bench.counters().refused_orders;
  const auto ask = [&](Order order, double toe_rad, double frequency_Hz) {
    second.order(order, toe_rad, frequency_Hz);
    for (int i = 0; i < 150; ++i) {
      second.poll(bench.lock_step.now_ns());
      bench.go(1);
    }
  };
  ask(Order::kRun, 0.1, 1);
  CHECK(second.refusal().find("not_owner") != std::string::npos);
  ask(Order::kReady, 0.6, 0);
  CHECK(second.refusal().find("not_owner") != std::string::npos);
  ask(Order::kReset, 0, 0);
  CHECK(second.refusal().find("not_owner") != std::string::npos);
  CHECK(bench.counters().refused_orders >= refused + 3);
  CHECK(bench.still());
  const auto after = bench.joints();
  for (std::size_t j = 0; j < 3; ++j) CHECK(std::abs(after[j] - before[j]) < kStill_rad);
  ask(Order::kStop, 0, 0);
  CHECK(second.accepted());
  CHECK_FALSE(bench.still());
}
