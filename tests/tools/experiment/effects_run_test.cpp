// Runs of the program with physics beyond the nominal plant, told and concealed.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/tools/experiment/program.h"

using hoof::tests::Outcome;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
using hoof::tools::read_file;
using hoof::tools::write_file;
namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

Strings run_on(const char* experiment, const fs::path& out, const Strings& more = {}) {
  Strings arguments = {experiment, "--terrain", "rft", "--quiet", "--out", out.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

nlohmann::json result(const fs::path& run) {
  return nlohmann::json::parse(read_file(run / "result.json"));
}

std::string effect(const std::string& name, const std::string& keys) {
  return "format = 1\n[effects." + name + "]\n" + keys;
}

}  // namespace

TEST_CASE("a run with effects says so, keeps them in its settings, and is replayed") {
  const ScratchFolder folder;
  const fs::path file = folder.path() / "play.toml", run = folder.path() / "run";
  write_file(file, effect("backlash", "gap = 0.02\njoint = \"toe\"\n"));
  const Outcome done = run_program(run_on("sinkage", run, {"--effects", file.string()}));
  REQUIRE(done.status == 0);
  CHECK_THAT(done.output, Catch::Contains("with backlash at the toe: gap 0.02 rad\n"));
  CHECK(result(run)["effects"]["backlash at the toe"] == "gap 0.02 rad");
  CHECK_THAT(read_file(run / "report.html"), Catch::Contains("Added physics, backlash at the toe"));
  CHECK_THAT(read_file(run / "settings.toml"), Catch::Contains("[effects.backlash]"));
  // The toes are held by the position loop; they give way by the play all the same.
  CHECK(result(run)["toe_deflection_rad"].get<double>() > 0.003);
  CHECK(run_program({"replay", run.string()}).status == 0);
}

TEST_CASE("a concealed run looks like a bench's; the truth is elsewhere, and makes the same run") {
  const ScratchFolder folder;
  const fs::path file = folder.path() / "hidden.toml", truth = folder.path() / "truth.toml";
  const fs::path sealed = folder.path() / "sealed", nominal = folder.path() / "nominal";
  write_file(file, effect("load_dependent_friction", "coefficient = 0.1\njoint = \"hip\"\n"));
  const Strings conceal = {"--effects", file.string(), "--conceal", truth.string()};
  REQUIRE(run_program(run_on("traction", sealed, conceal)).status == 0);
  REQUIRE(run_program(run_on("traction", nominal)).status == 0);
  CHECK(read_file(sealed / "settings.toml") == read_file(nominal / "settings.toml"));
  CHECK(read_file(sealed / "recording.json") == read_file(nominal / "recording.json"));
  CHECK(read_file(sealed / "bus.log") != read_file(nominal / "bus.log"));
  for (const auto& entry : fs::directory_iterator(sealed)) {
    const std::string text = read_file(entry.path());
    for (const char* word : {"friction_hip", "load_dependent", "effects"}) {
      INFO(entry.path().filename() << " " << word);
      CHECK(text.find(word) == std::string::npos);
    }
  }
  // Nor what only a simulator knows: torques in gears, true angles of toes.
  const std::string head = read_file(sealed / "samples.csv").substr(0, 400);
  for (const char* word : {"toe_left", "toe_torque", "hip_torque"}) {
    CHECK(head.find(word) == std::string::npos);
  }
  CHECK_FALSE(result(sealed).contains("torque_peak_Nm"));

  const fs::path told = folder.path() / "told";
  REQUIRE(run_program(run_on("traction", told, {"--effects", truth.string()})).status == 0);
  CHECK(read_file(told / "bus.log") == read_file(sealed / "bus.log"));
  // A truth is not written over.
  CHECK(run_program(run_on("traction", folder.path() / "more", conceal)).status == 2);
}

TEST_CASE("effects of no size leave a run's bytes as they were") {
  const ScratchFolder folder;
  const fs::path file = folder.path() / "none.toml";
  const fs::path with = folder.path() / "with", without = folder.path() / "without";
  write_file(file, effect("backlash", "gap = 0\n") + "[effects.spine_wear]\nloss = 0\n" +
                       "[effects.cohesion]\nstrength = 0\n[effects.transport_delay]\ndelay = 0\n");
  REQUIRE(run_program(run_on("sinkage", with, {"--effects", file.string()})).status == 0);
  REQUIRE(run_program(run_on("sinkage", without)).status == 0);
  for (const char* name : {"bus.log", "samples.csv", "telemetry.lcm"}) {
    CHECK(read_file(with / name) == read_file(without / name));
  }
}
