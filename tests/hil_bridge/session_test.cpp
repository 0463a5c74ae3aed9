// Whole tests on the rigid floor: real firmware, buses, drives and rigs.

#include "hil_bridge/session.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "firmware/protocol/codec.h"
#include "tests/hil_bridge/rigid_bench.h"

using namespace hoof;
using bridge::SessionResult;
using bridge::SessionSettings;
using bridge::TickRecord;
using bridge::Wires;
using firmware::control::Mode;
using test::SeenFrame;

namespace {

constexpr double kDegree_rad = 0.017453292519943295;

struct Recording {
  std::vector<SeenFrame> frames;
  std::vector<sim::Phase> phases;  // each once, in order
  std::set<Mode> modes;
  std::uint32_t ticks = 0;
};

/// A run whose every tick can be interfered with.
struct Bench {
  tools::RunSettings run;
  SessionSettings settings;
  std::unique_ptr<sim::Experiment> experiment;
  Recording seen;
  std::unique_ptr<Wires> wires =
      bridge::in_process_wires([this](int bus, const hal::CanFrame& frame) {
        seen.frames.push_back({bus, frame});
      });
  std::function<bool(const TickRecord&)> on_tick = [](const TickRecord&) { return true; };

  explicit Bench(const std::string& kind, const std::vector<std::string>& set = {})
      : run(test::rigid_run(kind, set)),
        settings(tools::session_settings(run)),
        experiment(test::rigid_bench(run)) {}

  SessionResult go() { return go_on(*wires); }

  SessionResult go_on(Wires& any_wires) {
    return bridge::run_session(*experiment, run.parameters, any_wires, settings,
                               [this](const TickRecord& record) {
                                 ++seen.ticks;
                                 seen.modes.insert(record.firmware.mode);
                                 const sim::Phase phase = record.plant.phase;
                                 if (seen.phases.empty() || seen.phases.back() != phase) {
                                   seen.phases.push_back(phase);
                                 }
                                 return on_tick(record);
                               });
  }
};

/// Wires on which one node can be heard no more from some frame on.
class MutingWires final : public Wires {
 public:
  MutingWires(Wires& inner, std::string node) : inner_(inner), node_(std::move(node)) {}

  hal::CanBus& attach(int bus, const std::string& node) override {
    hal::CanBus& port = inner_.attach(bus, node);
    if (node != node_) return port;
    muted_.push_back(std::make_unique<Port>(port, mute));
    return *muted_.back();
  }
  void advance_to(std::int64_t t_ns) override { inner_.advance_to(t_ns); }
  double load_ratio(int bus) const override { return inner_.load_ratio(bus); }
  double worst_load_ratio(int bus) const override { return inner_.worst_load_ratio(bus); }
  std::uint64_t frames() const override { return inner_.frames(); }

  bool mute = false;

 private:
  struct Port final : hal::CanBus {
    Port(hal::CanBus& port, const bool& mute) : port(port), mute(mute) {}
    hal::SendResult send(const hal::CanFrame& frame) override {
      return mute ? hal::SendResult::kQueued : port.send(frame);
    }
    bool receive(hal::CanFrame& frame) override { return port.receive(frame); }
    hal::BusStatus status() const override { return port.status(); }
    hal::CanBus& port;
    const bool& mute;
  };

  Wires& inner_;
  std::string node_;
  std::vector<std::unique_ptr<Port>> muted_;
};

bool same_frames(const std::vector<SeenFrame>& a, const std::vector<SeenFrame>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const SeenFrame& x, const SeenFrame& y) {
        return x.bus == y.bus && x.frame == y.frame && x.frame.stamp_ns == y.frame.stamp_ns;
      });
}

}  // namespace

TEST_CASE("sinkage: the toes are homed and opened to any angle, and held on the floor") {
  for (const int toe_deg : {0, 10, 20, 30, 40}) {
    CAPTURE(toe_deg);
    Bench bench("sinkage", {"experiment.toe_deg=" + std::to_string(toe_deg)});
    const SessionResult result = bench.go();
    CHECK(result.toe_command_rad == Approx(toe_deg * kDegree_rad));
    CHECK(std::abs(result.toe_reached_rad - result.toe_command_rad) < 0.5 * kDegree_rad);
    CHECK(result.toe_deflection_rad < 0.5 * kDegree_rad);
    CHECK_FALSE(result.interrupted);
    CHECK(bench.seen.phases == std::vector<sim::Phase>{sim::Phase::kPreparing,
                                                       sim::Phase::kLowering, sim::Phase::kLoaded,
                                                       sim::Phase::kFinished});
    CHECK(bench.seen.modes.count(Mode::kHoming) == 1);
    CHECK(bench.seen.modes.count(Mode::kReady) == 1);
    CHECK(bench.seen.modes.count(Mode::kDampedStop) == 1);
    CHECK(result.ticks == bench.seen.ticks);
    CHECK(result.frames == bench.seen.frames.size());
    CHECK(result.torque_peak_Nm[0] > 0.6);  // the push that tells the end stop
    CHECK(result.torque_peak_Nm[1] == 0);
    // Toe command and reply, SYNC, some telemetry; far from the bus plan's worst case of 47 %.
    CHECK(result.bus_load_ratio[0] > 0.25);
    CHECK(result.worst_bus_load_ratio[0] < 0.47);
    CHECK(result.bus_load_ratio[1] == Approx(0.08).margin(0.02));  // SYNC alone
  }
}

TEST_CASE("sinkage: a foot without toes needs no homing") {
  Bench bench("sinkage", {"use.foot=\"traditional\""});
  const SessionResult result = bench.go();
  CHECK(bench.seen.phases.back() == sim::Phase::kFinished);
  CHECK(result.toe_reached_rad == 0);
  CHECK(result.toe_deflection_rad == 0);
  CHECK(result.torque_peak_Nm[0] == 0);
}

TEST_CASE("traction: one stance under the firmware's legs") {
  Bench bench("traction", {"experiment.frequency_Hz=1"});
  double first_x_m = 0, last_x_m = 0;
  bench.on_tick = [&](const TickRecord& record) {
    if (record.plant.phase != sim::Phase::kLoaded) return true;
    CHECK(record.firmware.mode == Mode::kRunning);
    if (first_x_m == 0) first_x_m = record.plant.foot_m.x();
    last_x_m = record.plant.foot_m.x();
    return true;
  };
  const SessionResult result = bench.go();
  CHECK(bench.seen.phases == std::vector<sim::Phase>{sim::Phase::kPreparing, sim::Phase::kLoaded,
                                                     sim::Phase::kFinished});
  // To the rear; the floor does not yield, so the foot lags behind its ellipse.
  CHECK(first_x_m > 0.03);
  CHECK(last_x_m < 0);
  CHECK(std::abs(result.toe_reached_rad) < 0.5 * kDegree_rad);
  CHECK(result.torque_peak_Nm[1] > 10);
  CHECK(result.torque_peak_Nm[2] > 10);
  CHECK(result.worst_bus_load_ratio[1] < 0.635);  // the bus plan's worst case
}

TEST_CASE("the observer's false stops the run there and then") {
  Bench bench("sinkage");
  bench.on_tick = [&](const TickRecord&) { return bench.seen.ticks < 123; };
  const SessionResult result = bench.go();
  CHECK(result.interrupted);
  CHECK(result.ticks == 123);
  CHECK(bench.seen.ticks == 123);
}

TEST_CASE("a foot that is not ready in time is an error with what is known of it") {
  Bench bench("sinkage");
  bench.settings.prepare_limit_s = 0.1;
  CHECK_THROWS_WITH(
      bench.go(), Catch::StartsWith("the foot did not become ready within 0.100000 s of simulated "
                                    "time: mode 1, toes at ") &&
                      Catch::EndsWith(" of 0.349066 rad"));
}

TEST_CASE("an order that the firmware refuses is told in the firmware's words") {
  Bench bench("sinkage");
  bench.settings.toe_rad = 0.9;  // 52 degrees; the settings would have refused it before
  CHECK_THROWS_WITH(bench.go(),
                    Catch::EndsWith("the order 'ready' was refused: out_of_range (mode off)"));
}

TEST_CASE("an e-stop on the bus ends the run with the fault that the firmware reports") {
  Bench bench("sinkage");
  hal::CanBus& button = bench.wires->attach(0, "button");
  bench.on_tick = [&](const TickRecord& record) {
    if (record.plant.phase == sim::Phase::kLoaded) {
      button.send(encode(firmware::protocol::EmergencyStop{}));
    }
    return true;
  };
  CHECK_THROWS_WITH(
      bench.go(), Catch::EndsWith("s: the firmware reports emergency_stop in mode emergency_off"));
  CHECK(bench.seen.phases.back() == sim::Phase::kLoaded);
}

TEST_CASE("a drive that falls silent ends the run with the firmware's fault") {
  Bench bench("sinkage");
  MutingWires wires(*bench.wires, sim::joint_name(sim::Joint::kToe));
  bench.on_tick = [&](const TickRecord& record) {
    wires.mute = record.plant.phase == sim::Phase::kLowering;
    return true;
  };
  CHECK_THROWS_WITH(bench.go_on(wires),
                    Catch::Contains("the firmware reports drive_lost in mode damped_stop"));
}

TEST_CASE("a firmware that says nothing is no reason to wait for ever") {
  Bench bench("sinkage");
  bench.settings.prepare_limit_s = 0.2;
  MutingWires wires(*bench.wires, "foot");
  wires.mute = true;
  CHECK_THROWS_WITH(bench.go_on(wires), Catch::StartsWith("the foot did not become ready"));
}

TEST_CASE("the same run twice is the same, frame by frame and number by number") {
  for (const std::string kind : {"sinkage", "traction"}) {
    CAPTURE(kind);
    const std::string key = kind == "sinkage" ? "speed_m_s" : "frequency_Hz";
    const std::vector<std::string> set = {"experiment." + key + "=1", "experiment.toe_deg=20"};
    Bench first(kind, set);
    Bench second(kind, set);
    Bench other(kind, {set[0], "experiment.toe_deg=21"});
    const SessionResult a = first.go();
    const SessionResult b = second.go();
    other.go();
    CHECK(same_frames(first.seen.frames, second.seen.frames));
    CHECK_FALSE(same_frames(first.seen.frames, other.seen.frames));
    CHECK(a.ticks == b.ticks);
    CHECK(a.toe_reached_rad == b.toe_reached_rad);
    CHECK(a.toe_deflection_rad == b.toe_deflection_rad);
    CHECK(a.torque_peak_Nm == b.torque_peak_Nm);
    CHECK(a.bus_load_ratio == b.bus_load_ratio);
  }
}
