#include "tools/cli/experiment_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using Strings = std::vector<std::string>;

namespace {

Strings overrides_of(Experiment experiment, Strings arguments) {
  CLI::App app;
  ExperimentOptions options;
  add_experiment_options(app, options, experiment);
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants a vector
  app.parse(arguments);
  return settings_overrides(options);
}

Strings sinkage(const Strings& arguments) {
  return overrides_of(Experiment::kSinkage, arguments);
}
Strings traction(const Strings& arguments) {
  return overrides_of(Experiment::kTraction, arguments);
}

}  // namespace

TEST_CASE("flags become settings, and --set comes last") {
  CHECK(sinkage({}).empty());
  CHECK(sinkage({"--set",     "bed.seed=3", "--foot",    "bionic",
                 "--load",    "40",         "--load-as", "force",
                 "--speed",   "0.1",        "--toe",     "30",
                 "--bed",     "demo",       "--terrain", "dem",
                 "--bus",     "vcan0",      "--seed",    "7",
                 "--threads", "2",          "--set",     "experiment.toe_deg=20"}) ==
        Strings{"use.foot=\"bionic\"", "experiment.load_kg=40", "experiment.load_as=\"force\"",
                "experiment.speed_m_s=0.1", "experiment.toe_deg=30", "use.bed=\"demo\"",
                "experiment.terrain=\"dem\"", "experiment.bus=\"vcan0\"", "experiment.seed=7",
                "experiment.threads=2", "bed.seed=3", "experiment.toe_deg=20"});
  CHECK(traction({"--frequency", "1.12", "--drive", "prescribed"}) ==
        Strings{"experiment.frequency_Hz=1.12", "experiment.drive=\"prescribed\""});
}

TEST_CASE("a bare load is a mass in kg, N makes it a force") {
  CHECK(sinkage({"--load", "0.5"}) == Strings{"experiment.load_kg=0.5"});
  CHECK(sinkage({"--load", "40kg"}) == Strings{"experiment.load_kg=40"});
  CHECK(sinkage({"--load", "400N"}) == Strings{"experiment.load_N=400"});
  CHECK(sinkage({"--load", "4e2N"}) == Strings{"experiment.load_N=4e2"});
}

TEST_CASE("impossible values are refused, naming flag and bound") {
  struct Case {
    Strings arguments;
    const char* complaint;
  };
  const std::vector<Case> cases = {
      {{"--load", "-5"}, "--load: -5 is not above 0 kg"},
      {{"--load", "0"}, "--load: 0 is not above 0 kg"},
      {{"--load", "-400N"}, "--load: -400N is not above 0 N"},
      {{"--load", "40lb"}, "--load: '40lb' has the unit 'lb'; known are kg and N"},
      {{"--load", "heavy"}, "--load: 'heavy' is not a load such as 40, 40kg or 400N"},
      {{"--load", "nan"}, "--load: 'nan' is not a load"},
      {{"--load", "1,5"}, "--load: '1,5' is not a load"},
      {{"--load", "1e999"}, "--load: '1e999' is not a load"},
      {{"--load-as", "weight"}, "--load-as: 'weight' is none of force, mass"},
      {{"--toe", "55"}, "--toe: 55 degrees is outside 0..40"},
      {{"--toe", "-1"}, "--toe: -1 degrees is outside 0..40"},
      {{"--toe", "30rad"}, "--toe: '30rad' is not a number (in degrees)"},
      {{"--speed", "0"}, "--speed: 0 m/s is not above 0"},
      {{"--speed", "0.1mm"}, "--speed: '0.1mm' is not a number (in m/s)"},
      {{"--foot", "bear"}, "--foot: 'bear' is none of bionic, bionic-plain, traditional"},
      {{"--foot", "missing.stl"}, "--foot: 'missing.stl' is none of"},
      {{"--bed", "bigger"}, "--bed: 'bigger' is none of demo, medium, bench, paper"},
      {{"--terrain", "mud"}, "--terrain: 'mud' is none of dem, rft, rigid"},
      {{"--threads", "0"}, "--threads: Value 0 not in range"},
      {{"--seed", "-1"}, "--seed"},
      {{"--set", "seed"}, "--set: 'seed' is not of the form key=value"},
      {{"--set", "=3"}, "--set: '=3' is not of the form key=value"},
      {{"--checkpoint-every", "-1"}, "--checkpoint-every: -1 minutes is below 0"},
      {{"--checkpoint-every", "nan"}, "--checkpoint-every: 'nan' is not a number (in minutes)"},
      {{"--resume", "run", "--toe", "5"},
       "--resume: goes on with the settings of the run; --toe cannot be given with it"},
      {{"--set", "a=1", "--resume", "run"},
       "--resume: goes on with the settings of the run; --set cannot be given with it"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.arguments);
    CHECK_THROWS_WITH(sinkage(c.arguments), Catch::Contains(c.complaint));
    CHECK_THROWS_AS(sinkage(c.arguments), CLI::ParseError);
  }
  CHECK_THROWS_WITH(traction({"--frequency", "-1"}), Catch::Contains("-1 Hz is not above 0"));
}

TEST_CASE("the bounds themselves are allowed") {
  CHECK(sinkage({"--toe", "0"}) == Strings{"experiment.toe_deg=0"});
  CHECK(sinkage({"--toe", "40"}) == Strings{"experiment.toe_deg=40"});
}

TEST_CASE("what does not change the run may be said when it is resumed") {
  CHECK(sinkage({"--resume", "run", "--checkpoint-every", "0", "--force", "--live", "--quiet"})
            .empty());
}

TEST_CASE("flags of the other experiment are unknown") {
  CHECK_THROWS_AS(sinkage({"--frequency", "1"}), CLI::ExtrasError);
  CHECK_THROWS_AS(traction({"--speed", "1"}), CLI::ExtrasError);
}

TEST_CASE("a foot may be an STL file, and its path is a TOML string") {
  const hoof::tests::ScratchFolder scratch;
  const std::string stl = (scratch.path() / "a \"b\" \\c.stl").string();
  write_file(stl, "solid\n");
  const std::string folder = scratch.path().string();
  CHECK(sinkage({"--foot", stl}) ==
        Strings{"use.foot=\"stl\"", "foot.mesh_file=\"" + folder + "/a \\\"b\\\" \\\\c.stl\""});
  write_file(scratch.path() / "foot.obj", "");
  CHECK_THROWS_WITH(sinkage({"--foot", folder + "/foot.obj"}),
                    Catch::Contains("does not end in .stl"));
  CHECK_THROWS_AS(sinkage({"--foot", folder}), CLI::ParseError);
}
