#include "tools/experiment/run_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <thread>

#include "hil_bridge/fault_targets.h"
#include "sim/config/config_error.h"
#include "sim/config/reader.h"
#include "sim/config/suggestion.h"
#include "sim/experiments/resolution.h"
#include "tools/experiment/foot_plan.h"
#include "tools/experiment/run_bus.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using firmware::app::Parameters;

constexpr std::array<std::string_view, 14> kSections = {
    "experiment",  "foot",          "leg",     "bed", "materials", "drives",  "coupling",
    "rft_terrain", "rigid_terrain", "control", "use", "fault",     "effects", "setup"};

void refuse_unknown_sections(const sim::Settings& tree) {
  for (const auto& [key, entry] : tree.entries()) {
    const std::string_view section = std::string_view(key).substr(0, key.find('.'));
    if (std::find(kSections.begin(), kSections.end(), section) == kSections.end()) {
      throw sim::ConfigError(entry.origin.text() + ": " + key + ": no section '" +
                             std::string(section) +
                             "'; known are experiment, foot, leg, bed, "
                             "materials, drives, coupling, rft_terrain, rigid_terrain, control, "
                             "fault, effects, setup");
    }
  }
}

/// What the firmware of this rig is told about the rig: which drives there are, where the end stop
/// is, the leg's lengths and masses. A lab would calibrate the same numbers into its board.
Parameters rig_parameters(const RunSettings& run) {
  Parameters p;
  p.toe_present = run.foot.has_toes ? 1.0f : 0.0f;
  p.leg_present = run.firmware_leg() ? 1.0f : 0.0f;
  if (run.foot.has_toes) {
    p.control.homing.stop_angle_rad = float(run.foot.hinges.min_opening_rad);
    if (const auto& toe = run.drives[0]) {
      p.control.toe.friction_Nm = float(toe->coulomb_friction_Nm);
      p.control.toe.viscous_friction_Nm_s_rad = float(toe->viscous_friction_Nm_s_rad);
    }
  }
  if (!run.firmware_leg()) return p;
  const sim::Leg& leg = *run.leg;
  auto& m = p.control.leg_model;
  const auto inertia = [](const sim::Link& link) {
    return float(link.mass_kg * link.gyration_m * link.gyration_m);
  };
  m.thigh_m = float(leg.thigh.length_m), m.shank_m = float(leg.shank.length_m);
  m.thigh_mass_kg = float(leg.thigh.mass_kg), m.shank_mass_kg = float(leg.shank.mass_kg);
  m.thigh_centre_m = float(leg.thigh.com_from_joint_m);
  m.shank_centre_m = float(leg.shank.com_from_joint_m);
  m.thigh_inertia_kg_m2 = inertia(leg.thigh), m.shank_inertia_kg_m2 = inertia(leg.shank);
  m.foot_mass_kg = float(run.foot.mass_kg);
  if (const auto& hip = run.drives[1]) {
    m.rotor_inertia_kg_m2 = float(hip->rotor_inertia_kg_m2);
    m.friction_Nm = float(hip->coulomb_friction_Nm);
    m.viscous_friction_Nm_s_rad = float(hip->viscous_friction_Nm_s_rad);
  }
  // The plant's encoders of hip and knee read joint angles.
  for (const auto joint : {firmware::control::Joint::kHip, firmware::control::Joint::kKnee}) {
    p.calibration[index(joint)].done = 1.0f;
  }
  auto& path = p.control.path;
  path.semi_x_m = float(run.traction.ellipse.half_length_m);
  path.semi_z_m = float(run.traction.ellipse.half_height_m);
  path.centre_above_sand_m = float(run.traction.ellipse.centre_height_m);
  path.hip_above_sand_m = float(leg.hip_height_m);
  return p;
}

[[noreturn]] void fail(const sim::Entry& entry, const std::string& key, const std::string& rule) {
  throw sim::ConfigError(entry.origin.text() + ": " + key + " = " + sim::to_text(entry.value) +
                         ": " + rule);
}

/// The entries "control.NAME" over the rig's own.
void read_control(const sim::Settings& tree, Parameters& parameters) {
  constexpr std::string_view kPrefix = "control.";
  for (const auto& [key, entry] : tree.entries()) {
    if (!key.starts_with(kPrefix)) continue;
    const std::string_view name = std::string_view(key).substr(kPrefix.size());
    const firmware::app::ParameterEntry* p = firmware::app::find_parameter(name);
    if (p == nullptr) {
      std::vector<std::string> names;
      for (const auto& known : firmware::app::parameter_table()) names.emplace_back(known.name);
      const std::string near = sim::suggest(name, names);
      fail(entry, key,
           "the firmware has no such parameter" +
               (near.empty() ? "" : "; did you mean control." + near + "?"));
    }
    double value = 0;
    if (const auto* d = std::get_if<double>(&entry.value)) {
      value = *d;
    } else if (const auto* i = std::get_if<std::int64_t>(&entry.value)) {
      value = double(*i);
    } else {
      fail(entry, key, "must be a number");
    }
    if (set(parameters, name, float(value)) != firmware::app::SetResult::kOk) {
      fail(entry, key,
           "must be in " + format_number(p->minimum) + " ... " + format_number(p->maximum) + " " +
               std::string(p->unit));
    }
  }
}

/// Where `hoof firmware build` puts the image: beside the folder of this program.
std::string built_image() {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  const auto build = program.parent_path().parent_path().parent_path();
  return (build / "stm32f405" / "hoof-stm32f405.elf").string();
}

void read_experiment(const sim::Reader& root, RunSettings& run) {
  sim::Reader section = root.section("experiment");
  section.choice("kind", run.kind, {"sinkage", "traction"});
  section.choice("terrain", run.terrain, {"dem", "rft", "rigid"});
  section.text("bus", run.bus);
  section.choice("firmware", run.firmware, {"host", "emulated", "qemu"});
  std::string image;
  section.text("image", image);
  if (run.firmware != "host") run.image = image == "built" ? built_image() : image;
  // Settings that were written before there were fields have no such key.
  if (section.has("fields")) section.choice("fields", run.fields, {"none", "report", "vtk"});
  std::int64_t seed = 0;
  section.integer("seed", seed, 0, std::int64_t(1) << 53);
  run.seed = std::uint64_t(seed);
  section.integer("threads", run.threads, 0, 1024);
  if (run.threads == 0) run.threads = int(std::max(1u, std::thread::hardware_concurrency()));
  if (run.is_sinkage()) {
    run.sinkage = sim::read_sinkage(section);
  } else {
    run.traction = sim::read_traction(section);
  }
  section.finish();
}

/// A wall at the end of its path stops a foot, and what is measured then is the wall.
void refuse_walls_in_the_way(const RunSettings& run) {
  if (run.is_sinkage() || !run.on_grains() || run.bed.periodic_sides) return;
  const double least_m = sim::least_length_m(run.bed, reach_m(run));
  if (run.bed.box_length_m >= least_m) return;
  constexpr double kPapers_m = 0.530;
  fail(*run.tree.find("bed.box_length_mm"), "bed.box_length_mm",
       "must be at least " + format_number(std::ceil(1e3 * least_m)) +
           " for this traction: the ends of the foot go " +
           format_number(std::round(1e3 * reach_m(run))) +
           " mm to either side, and between them and the end walls a grain must fit" +
           (least_m <= kPapers_m ? "; bed.box_length_mm=530 is the paper's" : ""));
}

void read_drives(const sim::Reader& root, RunSettings& run) {
  sim::Reader drives = root.section("drives");
  std::string name;
  drives.text("name", name);
  const sim::DriveSettings toe = sim::read_drive(drives.section("toe"));
  const sim::DriveSettings hip = sim::read_drive(drives.section("hip"));
  const sim::DriveSettings knee = sim::read_drive(drives.section("knee"));
  drives.finish();
  if (run.foot.has_toes) run.drives[0] = toe;
  if (run.firmware_leg()) {
    run.drives[1] = hip;
    run.drives[2] = knee;
  }
}

void merge_faults(const std::string& fault_file, sim::Settings& tree) {
  const sim::Settings faults = sim::Settings::load_file(fault_file);
  for (const auto& [key, entry] : faults.entries()) {
    if (key.starts_with("fault.")) continue;
    fail(entry, key, "a file of faults has [[fault]] entries only");
  }
  if (faults.entries().empty()) {
    throw sim::ConfigError(fault_file + ": no [[fault]] entry");
  }
  tree.merge(faults);
}

void read_faults(RunSettings& run) {
  run.faults = bridge::read_faults(run.tree);
  for (const bridge::FaultSpec& fault : run.faults) {
    bridge::find_target(fault, run.has_drives());
    if (run.bus != kInProcess && bridge::needs_board(fault)) bridge::refuse_without_board(fault);
  }
}

}  // namespace

std::array<bool, sim::kJointCount> RunSettings::has_drives() const {
  return {drives[0].has_value(), drives[1].has_value(), drives[2].has_value()};
}

double reach_m(const RunSettings& run) {
  const Eigen::AlignedBox2d plan = foot_plan_m(run.foot, run.toe_rad());
  return run.traction.ellipse.half_length_m + std::max(plan.max().x(), -plan.min().x());
}

RunSettings read_run_settings(const std::string& experiment,
                              const std::vector<std::string>& overrides,
                              const std::string& fault_file, const std::string& effects_file) {
  RunSettings run;
  run.tree = sim::Settings::load_experiment(experiment, overrides);
  if (!fault_file.empty()) merge_faults(fault_file, run.tree);
  run.declared = run.tree;
  if (!effects_file.empty()) merge_effects(effects_file, run.tree);
  refuse_unknown_sections(run.tree);
  const sim::Reader root(run.tree);
  read_experiment(root, run);
  run.foot = sim::read_foot(root.section("foot"));
  run.foot_name = run.foot.name;
  if (!run.foot.has_toes && run.toe_rad() != 0) {
    const sim::Entry* entry = run.tree.find("experiment.toe_deg");
    // The default opening is for feet that can open; an opening that was asked for is an error.
    if (entry != nullptr && entry->origin.line == 0) {
      fail(*entry, "experiment.toe_deg", "the foot '" + run.foot_name + "' has no toes");
    }
    (run.is_sinkage() ? run.sinkage.toe_rad : run.traction.toe_rad) = 0;
  }
  if (!run.is_sinkage()) run.leg = sim::read_leg(root.section("leg"));
  run.bed = sim::read_bed(root.section("bed"));
  refuse_walls_in_the_way(run);
  run.materials = sim::read_materials(root.section("materials"));
  read_drives(root, run);
  run.coupling = sim::read_coupling(root.section("coupling"));
  run.rft = sim::read_rft_terrain(root.section("rft_terrain"));
  run.rigid = sim::read_rigid_terrain(root.section("rigid_terrain"));
  run.parameters = rig_parameters(run);
  read_control(run.tree, run.parameters);
  read_faults(run);
  read_run_effects(run);  // last: what the firmware is told of the plant is the nominal one
  return run;
}

}  // namespace hoof::tools
