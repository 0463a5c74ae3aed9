#include "tools/experiment/run_settings.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/config/config_error.h"
#include "tests/tools/experiment/stl_cube.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

using namespace hoof;
using tools::read_run_settings;
using tools::RunSettings;
using Strings = std::vector<std::string>;

namespace {

/// The whole message, which must be one line.
std::string refusal(const std::string& experiment, const Strings& set) {
  try {
    read_run_settings(experiment, set);
  } catch (const sim::ConfigError& error) {
    const std::string text = error.what();
    CHECK(text.find('\n') == std::string::npos);
    return text;
  }
  return "not refused";
}

}  // namespace

TEST_CASE("what is wrong with a setting is one line with origin, key, value and bound") {
  struct Case {
    const char* experiment;
    Strings set;
    const char* line;
  };
  const std::vector<Case> cases = {
      {"sinkage",
       {"experiment.spede_m_s=1"},
       "--set: experiment.spede_m_s = 1: unknown key, did you mean speed_m_s?"},
      {"sinkage",
       {"bead.depth_mm=1"},
       "--set: bead.depth_mm: no section 'bead'; known are experiment, foot, leg, bed, materials, "
       "drives, coupling, rft_terrain, rigid_terrain, control, fault, effects, setup"},
      {"sinkage",
       {"bed.depth_cm=12"},
       "--set: bed.depth_cm = 12: unknown key, did you mean depth_mm?"},
      {"sinkage",
       {"experiment.load_kg=-40"},
       "--set: experiment.load_kg = -40: must be a number from 0.01 to 10000.0 kg"},
      {"sinkage",
       {"experiment.load_kg=\"40\""},
       "--set: experiment.load_kg = \"40\": must be a number from 0.01 to 10000.0 kg"},
      {"sinkage",
       {"experiment.toe_deg=55"},
       "--set: experiment.toe_deg = 55: must be a number from 0.0 to 40.0 deg"},
      {"traction",
       {"bed.box_length_mm=380", "bed.grain_scale_ratio=0.5",
        "experiment.ellipse_half_length_mm=110"},
       "--set: bed.box_length_mm = 380: must be at least 402 for this traction: the ends of the "
       "foot "
       "go 198 mm to either side, and between them and the end walls a grain must fit; "
       "bed.box_length_mm=530 is the paper's"},
      {"traction",
       {"experiment.toe_deg=40.5"},
       "--set: experiment.toe_deg = 40.5: must be a number from 0.0 to 40.0 deg"},
      {"sinkage",
       {"use.foot=\"traditional\"", "experiment.toe_deg=20"},
       "--set: experiment.toe_deg = 20: the foot 'traditional' has no toes"},
      {"sinkage",
       {"control.toe_kp=100"},
       "--set: control.toe_kp = 100: the firmware has no such parameter; did you mean "
       "control.toe_kp_Nm_rad?"},
      {"sinkage",
       {"control.toe_kp_Nm_rad=501"},
       "--set: control.toe_kp_Nm_rad = 501: must be in 0 ... 500 Nm/rad"},
      {"sinkage",
       {"control.toe_kp_Nm_rad=-1"},
       "--set: control.toe_kp_Nm_rad = -1: must be in 0 ... 500 Nm/rad"},
      {"sinkage",
       {"control.toe_kp_Nm_rad=true"},
       "--set: control.toe_kp_Nm_rad = true: must be a number"},
      {"traction",
       {"experiment.speed_m_s=1"},
       "--set: experiment.speed_m_s = 1: unknown key, did you mean experiment.seed?"},
      {"traction",
       {"experiment.cycles=0"},
       "--set: experiment.cycles = 0: must be a whole number from 1 to 100"},
  };
  for (const Case& c : cases) CHECK(refusal(c.experiment, c.set) == c.line);
}

TEST_CASE("a foot that would be pulled against an end wall is refused, as it measures the wall") {
  // 100 + 87.5 mm to either side and 9.6 mm of the largest grain, twice.
  CHECK_THAT(
      refusal("traction", {"use.bed=medium"}),
      Catch::Contains("beds/medium.toml:") &&
          Catch::EndsWith(": bed.box_length_mm = 320: must be at least 395 for this traction: "
                          "the ends of the foot go 188 mm to either side, and between them "
                          "and the end walls a grain must fit; bed.box_length_mm=530 is the "
                          "paper's"));
  const auto length = [](const std::string& mm) {
    return refusal("traction", {"use.bed=medium", "bed.box_length_mm=" + mm});
  };
  CHECK(length("394") != "not refused");
  CHECK(length("395") == "not refused");
  // Where the paper's box is too short as well it is no advice.
  CHECK_THAT(refusal("traction", {"experiment.ellipse_half_length_mm=200"}),
             Catch::EndsWith("and the end walls a grain must fit"));
  // No wall, no grains, no path.
  CHECK(refusal("traction", {"use.bed=medium", "bed.sides=\"periodic\""}) == "not refused");
  CHECK(refusal("traction", {"use.bed=medium", "experiment.terrain=rft"}) == "not refused");
  CHECK(refusal("sinkage", {"use.bed=medium"}) == "not refused");
}

TEST_CASE("a mesh that is missing or open is refused with its name and place") {
  const tests::ScratchFolder scratch;
  const auto with_mesh = [&](const std::string& name) {
    return refusal("sinkage", {"use.foot=\"stl\"",
                               "foot.mesh_file=\"" + (scratch.path() / name).string() + "\""});
  };
  tools::write_file(scratch.path() / "closed.stl", tests::stl_cube(true));
  tools::write_file(scratch.path() / "open.stl", tests::stl_cube(false));
  CHECK(with_mesh("closed.stl") == "not refused");
  CHECK(with_mesh("missing.stl") ==
        (scratch.path() / "missing.stl").string() + ": cannot be read: No such file or directory");
  CHECK_THAT(with_mesh("open.stl"), Catch::StartsWith((scratch.path() / "open.stl").string()) &&
                                        Catch::Contains("the mesh has a hole"));
}

TEST_CASE("bounds themselves are taken") {
  const RunSettings run = read_run_settings(
      "sinkage", {"experiment.toe_deg=40", "control.toe_kp_Nm_rad=0", "experiment.load_kg=0.01"});
  CHECK(run.toe_rad() == Approx(40 * M_PI / 180));
  CHECK(run.parameters.control.toe.kp_Nm_rad == 0);
}

TEST_CASE("the firmware is told about its rig: drives, end stop, friction") {
  const RunSettings sinkage = read_run_settings("sinkage", {});
  CHECK(sinkage.parameters.toe_present == 1);
  CHECK(sinkage.parameters.leg_present == 0);
  CHECK(sinkage.parameters.control.homing.stop_angle_rad == Approx(-2 * M_PI / 180));
  CHECK(sinkage.drives[0]);
  CHECK_FALSE(sinkage.drives[1]);
  const RunSettings plain = read_run_settings("sinkage", {"use.foot=\"traditional\""});
  CHECK(plain.parameters.toe_present == 0);
  CHECK(plain.toe_rad() == 0);  // the default opening is for feet that have toes
  CHECK_FALSE(plain.drives[0]);
  const RunSettings traction = read_run_settings("traction", {"drives.hip.coulomb_friction_Nm=3"});
  CHECK(traction.parameters.leg_present == 1);
  CHECK(traction.parameters.control.leg_model.friction_Nm == 3);
  const RunSettings viscous = read_run_settings(
      "traction",
      {"drives.hip.viscous_friction_Nm_s_rad=0.7", "drives.toe.viscous_friction_Nm_s_rad=0.05"});
  CHECK(viscous.parameters.control.leg_model.viscous_friction_Nm_s_rad == 0.7f);
  CHECK(viscous.parameters.control.toe.viscous_friction_Nm_s_rad == 0.05f);
  CHECK(traction.parameters.control.path.semi_x_m == Approx(0.1));
  CHECK(traction.firmware_leg());
  const RunSettings prescribed = read_run_settings("traction", {"experiment.drive=\"prescribed\""});
  CHECK(prescribed.parameters.leg_present == 0);
  CHECK_FALSE(prescribed.drives[1]);
}

TEST_CASE("the firmware's own defaults for its drives are the shipped drives' data") {
  const RunSettings shipped = read_run_settings("traction", {});
  const firmware::app::Parameters defaults;
  const auto& m = shipped.parameters.control.leg_model;
  CHECK(m.friction_Nm == defaults.control.leg_model.friction_Nm);
  CHECK(m.viscous_friction_Nm_s_rad == defaults.control.leg_model.viscous_friction_Nm_s_rad);
  CHECK(m.rotor_inertia_kg_m2 == Approx(defaults.control.leg_model.rotor_inertia_kg_m2));
  const auto& toe = shipped.parameters.control.toe;
  CHECK(toe.friction_Nm == defaults.control.toe.friction_Nm);
  CHECK(toe.viscous_friction_Nm_s_rad == defaults.control.toe.viscous_friction_Nm_s_rad);
  // Hip and knee share one model in the firmware: their drives must be the same.
  CHECK(shipped.drives[1]->coulomb_friction_Nm == shipped.drives[2]->coulomb_friction_Nm);
  CHECK(shipped.drives[1]->viscous_friction_Nm_s_rad ==
        shipped.drives[2]->viscous_friction_Nm_s_rad);
}

TEST_CASE("a load in newtons overrides the one in kilograms") {
  CHECK(read_run_settings("sinkage", {"experiment.load_kg=10"}).sinkage.load_N == Approx(98.1));
  CHECK(read_run_settings("sinkage", {"experiment.load_N=400"}).sinkage.load_N == Approx(400));
}
