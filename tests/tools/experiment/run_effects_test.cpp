// [effects] and [setup] of a run: read, refused, written.
#include "tools/experiment/run_effects.h"

#include <catch2/catch.hpp>

#include "sim/config/config_error.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/experiment/run_settings.h"
#include "tools/run/output_file.h"

using namespace hoof;
using tools::read_run_settings;
using tools::RunSettings;
using Strings = std::vector<std::string>;

namespace {

class EffectsFile {
 public:
  explicit EffectsFile(const std::string& text) { tools::write_file(path(), text); }
  std::string path() const { return (folder_.path() / "e.toml").string(); }

  RunSettings read(const std::string& experiment, const Strings& set) const {
    return read_run_settings(experiment, set, "", path());
  }
  /// The message without the folder, which must be one line.
  std::string refusal(const std::string& experiment, const Strings& set) const {
    try {
      read(experiment, set);
    } catch (const sim::ConfigError& error) {
      std::string text = error.what();
      CHECK(text.find('\n') == std::string::npos);
      const std::size_t at = text.find("e.toml");
      return at == std::string::npos ? text : text.substr(at);
    }
    return "not refused";
  }

 private:
  tests::ScratchFolder folder_;
};

const Strings kRft = {"experiment.terrain=\"rft\""};

std::string one(const std::string& effect, const std::string& keys) {
  return "format = 1\n[effects." + effect + "]\n" + keys;
}

}  // namespace

TEST_CASE("effects and numbers of the plant are read; the firmware is told of neither") {
  const EffectsFile file(
      "format = 1\n[setup]\nsoil_stiffness = 2e7\nhip_coulomb = 6.5\n"
      "[effects.backlash]\ngap = 0.02\njoint = \"toe\"\n[effects.actuator_lag]\n"
      "time_constant = 0.004\n");
  const RunSettings run = file.read("traction", kRft);
  REQUIRE(run.effects.size() == 2);
  CHECK(run.effects[0].info->name == "actuator_lag");
  CHECK_FALSE(run.effects[0].joint.has_value());
  CHECK(run.effects[1].info->name == "backlash");
  CHECK(run.effects[1].joint == sim::Joint::kToe);
  CHECK(run.effects[1].values == std::vector<double>{0.02});
  CHECK(run.rft.xi_n_N_m3.value == 2e7);
  CHECK(run.drives[1]->coulomb_friction_Nm == 6.5);
  const RunSettings nominal = read_run_settings("traction", kRft);
  CHECK(run.parameters.control.leg_model.friction_Nm ==
        nominal.parameters.control.leg_model.friction_Nm);
  CHECK(run.declared.to_toml() == nominal.tree.to_toml());

  // What is written is read again: beside the run, and as a file of effects.
  tests::ScratchFolder folder;
  const std::string again = (folder.path() / "settings.toml").string();
  tools::write_file(again, run.tree.to_toml());
  const RunSettings resumed = read_run_settings(again, {});
  CHECK(tools::effects_toml(resumed, "x") == tools::effects_toml(run, "x"));
  tools::write_file(again, tools::effects_toml(run, "truth"));
  CHECK(tools::effects_toml(read_run_settings("traction", kRft, "", again), "x") ==
        tools::effects_toml(run, "x"));
}

TEST_CASE("what is wrong with effects is one line with file, key, value and what is allowed") {
  struct Case {
    std::string text;
    const char* experiment;
    Strings set;
    const char* line;
  };
  const std::string gap = "gap = 0.02\n";
  const std::vector<Case> cases = {
      {"[effects.backlash]\n" + gap, "sinkage", kRft, "e.toml: format: missing; must be 1"},
      {"format = 2\n", "sinkage", kRft, "e.toml:1:1: format = 2: must be 1"},
      {one("backlsh", gap), "sinkage", kRft,
       "e.toml:3:1: effects.backlsh.gap = 0.02: no effect of this name; did you mean backlash?"},
      {one("backlash", "gap = -1\n"), "sinkage", kRft,
       "e.toml:3:1: effects.backlash.gap = -1: must be a number from 0 to 1 rad"},
      {one("backlash", "gap = \"wide\"\n"), "sinkage", kRft,
       "e.toml:3:1: effects.backlash.gap = \"wide\": must be a number from 0 to 1 rad"},
      {one("backlash", gap + "gab = 1\n"), "sinkage", kRft,
       "e.toml:4:1: effects.backlash.gab = 1: no such parameter; did you mean gap?"},
      {one("backlash", gap + "joint = \"ankle\"\n"), "sinkage", kRft,
       "e.toml:4:1: effects.backlash.joint = \"ankle\": must be \"toe\", \"hip\" or \"knee\""},
      {one("backlash", gap + "joint = \"hip\"\n"), "sinkage", kRft,
       "e.toml:3:1: effects.backlash: this run has no drive at the hip"},
      {one("backlash", gap),
       "sinkage",
       {"use.foot=\"traditional\""},
       "e.toml:3:1: effects.backlash: this run has no drives"},
      {one("hard_layer", "depth = 0.01\n"), "sinkage", kRft,
       "e.toml:3:1: effects.hard_layer.depth: hard_layer needs ratio, too"},
      {one("cohesion", "strength = 100\njoint = \"toe\"\n"), "sinkage", kRft,
       "e.toml:4:1: effects.cohesion.joint = \"toe\": no such parameter"},
      {one("cohesion", "strength = 100\n"),
       "sinkage",
       {},
       "e.toml:3:1: effects.cohesion: grains follow the laws of their contacts, which know no such "
       "term; use terrain rft"},
      {one("cohesion", "strength = 100\n"),
       "sinkage",
       {"experiment.terrain=\"rigid\""},
       "e.toml:3:1: effects.cohesion: a rigid floor is no soil; use terrain rft"},
      {one("plate_size_law", "exponent = 0.2\n"), "sinkage", kRft,
       "e.toml:3:1: effects.plate_size_law: a foot of facets has no one width"},
      {one("supply_sag", "resistance = 1\n"), "sinkage", kRft,
       "e.toml:3:1: effects.supply_sag: the drives of the foot have no supply voltage in their "
       "model"},
      {one("spine_wear", "loss = 0.002\n"),
       "sinkage",
       {"use.foot=\"bionic-plain\""},
       "e.toml:3:1: effects.spine_wear: the foot 'bionic-plain' has no spines"},
      {"format = 1\n[setup]\nsoil_stifness = 1e7\n", "sinkage", kRft,
       "e.toml:3:1: setup.soil_stifness = 1e+07: no such number of the foot's plant; did you mean "
       "soil_stiffness?"},
      {"format = 1\n[setup]\nsoil_stiffness = 1e7\n",
       "sinkage",
       {},
       "e.toml:3:1: setup.soil_stiffness = 1e+07: this run has no such number"},
      {"format = 1\n[experiment]\nload_kg = 3\n", "sinkage", kRft,
       "e.toml:3:1: experiment.load_kg = 3: a file of effects has format, [setup] and "
       "[effects.NAME] only"},
  };
  for (const Case& c : cases) {
    INFO(c.text);
    CHECK(EffectsFile(c.text).refusal(c.experiment, c.set) == c.line);
  }
}
