#include "hil_bridge/lock_step.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "firmware/protocol/codec.h"
#include "tests/hil_bridge/rigid_bench.h"

using namespace hoof;
using bridge::LockStep;
using test::SeenFrame;
namespace protocol = firmware::protocol;

namespace {

/// Firmware, buses, drives and rig of one experiment.
struct Bench {
  tools::RunSettings run;
  std::unique_ptr<sim::Experiment> experiment;
  std::vector<SeenFrame> seen;
  std::unique_ptr<bridge::Wires> wires =
      bridge::in_process_wires([this](int bus, const hal::CanFrame& frame) {
        seen.push_back({bus, frame});
      });
  LockStep lock_step;

  explicit Bench(const std::string& kind, const std::vector<std::string>& set = {})
      : run(test::rigid_run(kind, set)),
        experiment(test::rigid_bench(run)),
        lock_step(*experiment, run.parameters, *wires) {}

  std::vector<SeenFrame> frames_of(std::uint32_t id) const {
    std::vector<SeenFrame> found;
    for (const SeenFrame& s : seen) {
      if (s.frame.id == id) found.push_back(s);
    }
    return found;
  }
};

}  // namespace

TEST_CASE("a tick is a millisecond of clock and plant, and one SYNC on each bus") {
  Bench bench("sinkage");
  constexpr std::uint32_t kTicks = 25;
  for (std::uint32_t i = 0; i < kTicks; ++i) {
    CHECK(bench.lock_step.ticks() == i);
    bench.lock_step.tick();
    CHECK(bench.lock_step.now_ns() == (i + 1) * LockStep::kTick_ns);
    // Sums of 50 us, so not exact.
    CHECK(bench.experiment->time_s() == Approx((i + 1) * 1e-3).epsilon(1e-12));
  }
  std::map<int, std::uint32_t> next;
  for (const SeenFrame& s : bench.frames_of(protocol::spec(protocol::Message::kSync).id)) {
    protocol::Sync sync;
    REQUIRE(decode(s.frame, sync) == protocol::DecodeResult::kOk);
    CHECK(sync.tick == next[s.bus]++);
    // Nothing is on the wires when a tick begins, so its SYNC is the first frame of it.
    const std::int64_t since_tick_ns = s.frame.stamp_ns - sync.tick * LockStep::kTick_ns;
    CHECK(since_tick_ns > 0);
    CHECK(since_tick_ns < 100'000);  // 4 bytes: at most 92 bits
  }
  CHECK(next == std::map<int, std::uint32_t>{{0, kTicks}, {1, kTicks}});
}

TEST_CASE("within one tick every drive gets one command and answers it, each on its own bus") {
  Bench bench("traction");
  constexpr int kTicks = 10;
  for (int i = 0; i < kTicks; ++i) bench.lock_step.tick();
  for (const protocol::Drive drive : protocol::kDrives) {
    for (const std::uint32_t id :
         {protocol::command_spec(drive).id, protocol::reply_spec(drive).id}) {
      const auto frames = bench.frames_of(id);
      REQUIRE(frames.size() == kTicks);
      for (int i = 0; i < kTicks; ++i) {
        CHECK(frames[i].bus == (drive == protocol::Drive::kToe ? 0 : 1));
        CHECK(frames[i].frame.stamp_ns / LockStep::kTick_ns == i);
      }
    }
  }
}

TEST_CASE("a rig without leg drives has no frames for them") {
  Bench bench("sinkage");
  for (int i = 0; i < 10; ++i) bench.lock_step.tick();
  for (const SeenFrame& s : bench.seen) {
    if (s.bus == 1) CHECK(s.frame.id == protocol::spec(protocol::Message::kSync).id);
  }
}

TEST_CASE("the firmware runs once per SYNC and knows the plant by its frames alone") {
  Bench bench("sinkage");
  bench.lock_step.supervisor().order(protocol::Order::kReady, 0.2);
  for (int i = 0; i < 30; ++i) bench.lock_step.tick();
  CHECK(bench.lock_step.firmware().telemetry().counters.ticks == 30);
  CHECK(bench.lock_step.firmware().telemetry().counters.missed_ticks == 0);
  CHECK(bench.lock_step.firmware().telemetry().counters.bad_frames() == 0);
  CHECK(bench.lock_step.supervisor().accepted());
  CHECK(bench.lock_step.firmware().mode() == firmware::control::Mode::kHoming);
  REQUIRE(bench.lock_step.supervisor().heartbeat());
  CHECK(bench.lock_step.supervisor().heartbeat()->mode == protocol::Mode::kHoming);
}

TEST_CASE("torques of a tick are those of the gears, mean and largest") {
  Bench bench("traction");  // the leg hangs at its start; without drives on it falls
  bench.lock_step.supervisor().order(protocol::Order::kReady);
  for (int i = 0; i < 200; ++i) {
    bench.lock_step.tick();
    const bridge::TickTorques& t = bench.lock_step.torques();
    for (int j = 0; j < sim::kJointCount; ++j) {
      CHECK(std::abs(t.mean_Nm[j]) <= t.peak_Nm[j] * (1 + 1e-12));
      CHECK(t.peak_Nm[j] >= std::abs(bench.experiment->plant().joint_torque_Nm(sim::Joint(j))));
    }
  }
  // The hip carries the leg: 8 kg some centimetres away from it.
  CHECK(bench.lock_step.torques().peak_Nm[1] > 0.5);
}

TEST_CASE("an exchange interval must divide the tick") {
  CHECK_NOTHROW(Bench("sinkage", {"coupling.exchange_us=25"}));
  CHECK_NOTHROW(Bench("sinkage", {"coupling.exchange_us=100"}));
  CHECK_THROWS_AS(Bench("sinkage", {"coupling.exchange_us=70"}), std::invalid_argument);
  CHECK_THROWS_WITH(Bench("sinkage", {"coupling.exchange_us=33.3"}),
                    "coupling.exchange_us = 33.300000 does not divide the control tick of 1000 us");
}

namespace {

/// Time from outside: most ticks come one by one, every hundredth rest has slept through two more.
class UnevenPace final : public bridge::Pace {
 public:
  std::uint32_t rest(const std::function<void()>& poll) override {
    poll();
    return ++rests_ % 100 == 0 ? 3 : 1;
  }

 private:
  int rests_ = 0;
};

}  // namespace

TEST_CASE("at a pace from outside the plant keeps up with it, and the foot homes and opens") {
  const tools::RunSettings run = test::rigid_run("sinkage");
  const auto experiment = test::rigid_bench(run);
  std::vector<std::uint32_t> numbers;
  const auto wires = bridge::in_process_wires([&](int bus, const hal::CanFrame& frame) {
    protocol::Sync sync;
    if (bus == 0 && decode(frame, sync) == protocol::DecodeResult::kOk)
      numbers.push_back(sync.tick);
  });
  UnevenPace pace;
  LockStep lock_step(
      *experiment,
      [&](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
        return std::make_unique<bridge::LocalFirmware>(bus0, bus1, clock, run.parameters);
      },
      *wires, &pace);
  lock_step.supervisor().order(protocol::Order::kReady, 0.2);
  const auto open = [&] {
    const auto& toe = lock_step.supervisor().toe();
    return lock_step.supervisor().accepted() && toe && !toe->moving &&
           std::abs(double(toe->measured_rad) - 0.2) < 0.01;
  };
  while (!open() && lock_step.ticks() < 8'000) lock_step.tick();
  CHECK(open());
  CHECK(lock_step.supervisor().trouble() == "");
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const std::uint32_t step = numbers[i] - numbers[i - 1];
    REQUIRE((step == 1 || step == 3));
    jumps += step == 3;
  }
  CHECK(jumps == numbers.size() / 100);
  // The plant has gone on by all ticks but those that are due now.
  CHECK(lock_step.now_ns() >= (std::int64_t(lock_step.ticks()) - 3) * LockStep::kTick_ns);
  CHECK(experiment->time_s() == Approx(double(lock_step.now_ns()) * 1e-9).epsilon(1e-9));
}
