#include "tools/experiment/bench.h"

#include <filesystem>

#include "sim/experiments/resolution.h"
#include "sim/multibody/prescribed_rig.h"
#include "sim/multibody/sinkage_rig.h"
#include "sim/multibody/traction_rig.h"
#include "sim/terrain/bed_store.h"
#include "sim/terrain/dem_terrain.h"
#include "sim/terrain/rft_terrain.h"
#include "tools/experiment/foot_plan.h"

namespace hoof::tools {
namespace {

std::unique_ptr<sim::Rig> make_rig(const RunSettings& run) {
  if (run.is_sinkage()) {
    sim::SinkageRigSettings s;
    s.foot = foot_with_effects(run);
    s.load_N = run.sinkage.load_N;
    s.load_as = run.sinkage.load_as;
    s.start_height_m = run.sinkage.start_height_m;
    return std::make_unique<sim::SinkageRig>(s);
  }
  const sim::FootPoint top = run.traction.ellipse.at(0);
  if (run.traction.prescribed) {
    return std::make_unique<sim::PrescribedRig>(foot_with_effects(run), *run.leg, top);
  }
  sim::TractionRigSettings s;
  s.foot = foot_with_effects(run);
  s.leg = *run.leg;
  s.start_x_m = top.x_m;
  s.start_z_m = top.z_m;
  return std::make_unique<sim::TractionRig>(s);
}

sim::BedState settled_bed(const RunSettings& run, const BenchProgress& progress,
                          const BenchNote& note) {
  const sim::BedStore store(std::filesystem::path(HOOF_CACHE_DIR) / "beds");
  const std::filesystem::path file = store.file(run.bed, run.materials, run.seed);
  if (!std::filesystem::exists(file)) {
    note("settling the bed '" + run.bed.name + "' (about " +
         std::to_string(sim::grains_to_pour(run.bed, 0.6)) +
         " grains poured); kept for later runs");
  }
  sim::StoredBed bed = store.get(run.bed, run.materials, run.seed, run.threads, progress);
  if (!bed.discarded.empty()) note(bed.discarded + "; the bed was made anew");
  return std::move(bed.state);
}

std::unique_ptr<sim::Terrain> make_terrain(const RunSettings& run, const BenchProgress& progress,
                                           const BenchNote& note,
                                           const std::optional<sim::JournalSettings>& journal) {
  if (run.terrain == "rigid") return std::make_unique<sim::RigidTerrain>(run.rigid);
  if (run.terrain == "rft") {
    auto soil = std::make_unique<sim::RftTerrain>(run.rft);
    add_soil_effects(run, *soil);
    return soil;
  }
  const Eigen::Vector2d print_m = foot_plan_m(run.foot, run.toe_rad()).sizes();
  for (const std::string& warning : sim::box_warnings(run.bed, print_m.x(), print_m.y())) {
    note(warning);
  }
  if (!run.is_sinkage()) {
    const std::string near = sim::wall_warning(run.bed, reach_m(run), run.traction.ellipse);
    if (!near.empty()) note(near);
  }
  auto sand = std::make_unique<sim::DemTerrain>(
      sim::dem_settings(run.bed, run.materials, run.threads), settled_bed(run, progress, note));
  if (!journal) return sand;
  return std::make_unique<sim::JournaledTerrain>(std::move(sand), *journal);
}

}  // namespace

std::unique_ptr<sim::Experiment> make_experiment(
    const RunSettings& run, const BenchProgress& progress, const BenchNote& note,
    const std::optional<sim::JournalSettings>& journal) {
  auto plant = std::make_unique<sim::Plant>(
      make_rig(run), run.drives, make_terrain(run, progress, note, journal), run.coupling);
  add_joint_effects(run, *plant);
  if (run.is_sinkage()) return std::make_unique<sim::Sinkage>(run.sinkage, std::move(plant));
  return std::make_unique<sim::Traction>(run.traction, std::move(plant));
}

bridge::SessionSettings session_settings(const RunSettings& run) {
  bridge::SessionSettings s;
  s.has_toes = run.foot.has_toes;
  s.toe_rad = run.toe_rad();
  s.firmware_leg = run.firmware_leg();
  s.frequency_Hz = run.traction.frequency_Hz;
  return s;
}

const sim::SandBed* find_sand(const sim::Terrain& ground) {
  const sim::Terrain* under = &ground;
  if (const auto* journaled = dynamic_cast<const sim::JournaledTerrain*>(under)) {
    under = &journaled->ground();
  }
  const auto* sand = dynamic_cast<const sim::DemTerrain*>(under);
  return sand == nullptr ? nullptr : &sand->bed();
}

}  // namespace hoof::tools
