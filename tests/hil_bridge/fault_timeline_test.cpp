// Faults as they are written, when they begin and end, and that each really changes something.

#include "hil_bridge/fault_timeline.h"

#include <catch2/catch.hpp>

#include "firmware/protocol/codec.h"
#include "hil_bridge/session.h"
#include "sim/config/config_error.h"
#include "tests/hil_bridge/fault_bench.h"

using namespace hoof;
using bridge::FaultTimeline;
using bridge::SessionResult;
using test::SeenFrame;
using Strings = std::vector<std::string>;
namespace fault = firmware::control::fault;

namespace {

const FaultTimeline::Drives kToeOnly = {true, false, false};

const auto parse = test::parse_faults;
const auto run = test::run_with_faults;
using Outcome = test::FaultRun;

void build(const std::string& toml) {
  FaultTimeline(parse(toml), kToeOnly);
}

std::size_t frames_between(const Outcome& outcome, std::uint32_t id, double from_s, double to_s) {
  std::size_t count = 0;
  for (const SeenFrame& s : outcome.frames) {
    const double t = double(s.frame.stamp_ns) * 1e-9;
    count += s.frame.id == id && t >= from_s && t < to_s;
  }
  return count;
}

}  // namespace

TEST_CASE("a fault that is written wrong is told by file, line, key, value and bound") {
  struct Case {
    const char* toml;
    const char* message;
  };
  const Case cases[] = {
      {"[[fault]]\nkind = \"frob\"\ntarget = \"toe\"\nat_s = 1",
       "faults.toml:2:1: fault.0.kind = \"frob\": must be one of drop,"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"", "needs one of at_s, at_tick and when"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = 1\nat_tick = 3", "needs one of"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = -1",
       "faults.toml:4:1: fault.0.at_s = -1: must be"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = 1\nprobability = 2",
       "fault.0.probability = 2"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = 1\ndelay_ms = 2", "delay_ms"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"hip\"\nat_s = 1",
       "must be a drive of this rig: toe"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"HipReply\"\nat_s = 1",
       "this rig has no such drive, only toe"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"Frob\"\nat_s = 1",
       "faults.toml:2:1: fault.0.target = \"Frob\": must be a bus (can0, can1)"},
      {"[[fault]]\nkind = \"stall\"\ntarget = \"can0\"\nat_s = 1",
       "must be a drive of this rig: toe"},
      {"[[fault]]\nkind = \"flood\"\ntarget = \"toe\"\nat_s = 1", "must be can0 or can1"},
      {"[[fault]]\nkind = \"bus_off\"\ntarget = \"Sync\"\nat_s = 1",
       "must be a node of this rig: foot, sync, supervisor, toe"},
      {"[[fault]]\nkind = \"estop\"\ntarget = \"toe\"\nat_s = 1", "must be line"},
      {"[[fault]]\nkind = \"brown_out\"\ntarget = \"toe\"\nat_s = 1", "must be foot, or left out"},
      {"[[fault]]\nkind = \"node_restart\"\ntarget = \"sync\"\nat_s = 1",
       "must be foot or a drive"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nwhen = \"depth > 1\"",
       "no signal 'depth'; there are time_s"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nwhen = \"depth_m ~ 1\"", "no comparison '~'"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nwhen = \"depth_m > x\"",
       "'x' is not a number"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nwhen = \"mode == walking\"",
       "no mode 'walking'; there are off"},
      {"[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = 2\nuntil_s = 1",
       "must lie behind the start"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.toml);
    CHECK_THROWS_WITH(build(c.toml), Catch::Contains(c.message));
    CHECK_THROWS_AS(build(c.toml), sim::ConfigError);
  }
}

TEST_CASE("faults of a board are refused where the firmware is not in this process") {
  /// As one on the bus, without a board that could be reached.
  class Elsewhere final : public bridge::FirmwareNode {
   public:
    Elsewhere(hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock,
              const firmware::app::Parameters& parameters)
        : inner_(bus0, bus1, clock, parameters) {}
    void poll(std::uint32_t tick) override { inner_.poll(tick); }
    const firmware::app::Telemetry& telemetry() const override { return inner_.telemetry(); }

   private:
    bridge::LocalFirmware inner_;
  };
  const tools::RunSettings settings = test::rigid_run("sinkage");
  const bridge::FirmwareMaker make = [&](hal::CanBus& bus0, hal::CanBus& bus1,
                                         const hal::Clock& clock) {
    return std::make_unique<Elsewhere>(bus0, bus1, clock, settings.parameters);
  };
  const auto bind = [&](const std::string& fault) {
    const auto experiment = test::rigid_bench(settings);
    const auto wires = bridge::in_process_wires({});
    FaultTimeline faults(parse("[[fault]]\nat_s = 1\n" + fault), kToeOnly);
    bridge::LockStep lock_step(*experiment, make, faults.wires(*wires));
    faults.bind(lock_step, *experiment);
  };
  for (const char* fault : {"kind = \"brown_out\"", "kind = \"estop\"\ntarget = \"line\"",
                            "kind = \"node_restart\"\ntarget = \"foot\""}) {
    CAPTURE(fault);
    CHECK_THROWS_WITH(bind(fault), Catch::Contains("faults.toml:3:1: fault.0 (") &&
                                       Catch::Contains("out of reach; leave out --bus"));
  }
  for (const char* fault :
       {"kind = \"node_restart\"\ntarget = \"toe\"", "kind = \"estop\"\ntarget = \"can0\"",
        "kind = \"bus_off\"\ntarget = \"foot\""}) {
    CHECK_NOTHROW(bind(fault));
  }
}

TEST_CASE("eleven faults keep their order") {
  std::string toml;
  for (int i = 0; i < 11; ++i) {
    toml += "[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = " + std::to_string(i) + "\n";
  }
  const auto faults = parse(toml);
  REQUIRE(faults.size() == 11);
  for (int i = 0; i < 11; ++i) CHECK(faults[std::size_t(i)].at_s == i);
}

TEST_CASE("dropped frames are off the wire from the tick they begin to the tick they end") {
  const Outcome o =
      run("sinkage", "[[fault]]\nkind = \"drop\"\ntarget = \"ToeReply\"\nat_s = 0.5\nfor_s = 0.01");
  CHECK(o.result.ended_by == "");  // ten ticks are forgiven
  CHECK(frames_between(o, 0x031, 0.49, 0.5) == 10);
  CHECK(frames_between(o, 0x031, 0.5, 0.51) == 0);
  CHECK(frames_between(o, 0x031, 0.51, 0.52) == 10);
  REQUIRE(o.result.faults.size() == 1);
  CHECK(o.result.faults[0].changed == 10);
  CHECK(*o.result.faults[0].began_s == Approx(0.5));
  CHECK(*o.result.faults[0].ended_s == Approx(0.51));
}

TEST_CASE("a silent drive: the run goes on to the safe state and a reset, and tells both") {
  const Outcome o = run(
      "sinkage", "[[fault]]\nkind = \"node_silent\"\ntarget = \"toe\"\nat_tick = 500\nfor_s = 0.1");
  const bridge::Reaction& r = *o.result.reaction;
  CHECK(r.faults == fault::kDriveLost);
  CHECK(*r.tripped_s - 0.5 == Approx(0.021).margin(0.002));
  CHECK(*r.safe_s - 0.5 <= 0.024);
  REQUIRE(r.reset_s);
  CHECK(r.mode == "off");
  CHECK(o.result.ended_by.find("drive_lost") != std::string::npos);
}

TEST_CASE("a condition begins a fault in the tick after it holds") {
  const Outcome o = run("sinkage",
                        "[[fault]]\nkind = \"estop\"\ntarget = \"line\"\nfor_s = 0.02\n"
                        "when = \"mode == ready\"");
  CHECK(o.result.reaction->faults == fault::kEmergencyStop);
  CHECK(*o.result.reaction->safe_s - *o.result.faults[0].began_s <= 0.003);
}

TEST_CASE("a fault that never begins, or changes nothing, is an error") {
  CHECK_THROWS_WITH(run("sinkage", "[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nat_s = 3000"),
                    Catch::Contains("fault.0 (drop toe) never began: the run ended before"));
  CHECK_THROWS_WITH(
      run("sinkage", "[[fault]]\nkind = \"drop\"\ntarget = \"toe\"\nwhen = \"depth_m > 5\""),
      Catch::Contains("depth_m > 5 never held"));
  // Nobody asks for parameters in a run.
  CHECK_THROWS_WITH(
      run("sinkage", "[[fault]]\nkind = \"drop\"\ntarget = \"ServiceAnswer\"\nat_s = 0.1"),
      Catch::Contains("faults.toml:2:1: fault.0 (drop ServiceAnswer) changed nothing"));
}

TEST_CASE("what is random comes out the same with the same seed, otherwise with another") {
  const auto lost = [](int seed) {
    const Outcome o = run("sinkage",
                          "[[fault]]\nkind = \"drop\"\ntarget = \"ToeReply\"\nat_s = 0.3\n"
                          "for_s = 0.4\nprobability = 0.3\nseed = " +
                              std::to_string(seed));
    return std::make_pair(o.result.faults[0].changed, o.frames);
  };
  const auto a = lost(1), b = lost(1), c = lost(2);
  CHECK(a.first == b.first);
  CHECK(std::equal(a.second.begin(), a.second.end(), b.second.begin(), b.second.end(),
                   [](const SeenFrame& x, const SeenFrame& y) { return x.frame == y.frame; }));
  CHECK(a.second.size() != c.second.size());
  // 400 frames, 0.3 of them: 120, standard deviation 9.
  CHECK(double(a.first) == Approx(120).margin(45));
}

TEST_CASE("the same run without faults is the same, frame by frame, behind idle effects") {
  const Outcome o = run("sinkage",
                        "[[fault]]\nkind = \"estop\"\ntarget = \"line\"\nat_s = 0.6\nfor_s = 0.02\n"
                        "[[fault]]\nkind = \"corrupt\"\ntarget = \"toe\"\nat_s = 0.599\n"
                        "for_s = 0.001");
  const tools::RunSettings settings = test::rigid_run("sinkage");
  const auto experiment = test::rigid_bench(settings);
  std::vector<SeenFrame> plain;
  const auto wires = bridge::in_process_wires([&](int bus, const hal::CanFrame& frame) {
    plain.push_back({bus, frame});
  });
  bridge::SessionSettings session;
  session.toe_rad = settings.toe_rad();
  run_session(*experiment, settings.parameters, *wires, session,
              [](const bridge::TickRecord& r) { return r.plant.time_s < 0.59; });
  REQUIRE(plain.size() > 1000);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    REQUIRE(plain[i].frame == o.frames[i].frame);
    REQUIRE(plain[i].frame.stamp_ns == o.frames[i].frame.stamp_ns);
  }
}
