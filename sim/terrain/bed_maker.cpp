#include "sim/terrain/bed_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/terrain/bed_file.h"

namespace hoof::sim {
namespace {

// Steps between two looks at the energy. A bed's own sloshing (a wave up and down through its
// depth) takes some hundred steps, so that rest is energy that stays low for ten looks.
constexpr int kPieceSteps = 100;
constexpr int kQuietPieces = 10;

// With 27 % of the Rayleigh time nothing changed in a pressed bed, with 40 % nothing that could be
// told from noise, at 54 % grains were thrown out at 5 m/s (measured on plates pressed into sand).
constexpr double kLargestStepOverRayleigh = 0.40;

/// A scraper passes at z = 0: every grain that stands above is taken away.
void scrape(BedState& state) {
  std::vector<Grain> kept;
  for (const Grain& g : state.grains) {
    if (g.p_m.z() + g.radius_m <= 0) kept.push_back(g);
  }
  std::vector<std::uint32_t> ids;
  for (const Grain& g : kept) ids.push_back(g.id);
  const auto there = [&](std::uint32_t id) {
    return id >= GrainContact::kWallContact || std::binary_search(ids.begin(), ids.end(), id);
  };
  std::erase_if(state.contacts, [&](const GrainContact& c) { return !there(c.i) || !there(c.j); });
  state.grains = std::move(kept);
}

void number_from_zero(BedState& state) {
  std::vector<std::uint32_t> ids;
  for (const Grain& g : state.grains) ids.push_back(g.id);
  const auto place = [&](std::uint32_t id) {
    return std::uint32_t(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
  };
  for (GrainContact& c : state.contacts) {
    c.i = place(c.i);
    if (c.j < GrainContact::kWallContact) c.j = place(c.j);
  }
  for (std::uint32_t i = 0; i < state.grains.size(); ++i) state.grains[i].id = i;
}

/// Lifts each grain by its own diameter, J.
double lift_energy_J(const BedState& state, const DemSettings& dem) {
  double sum = 0;
  for (const Grain& g : state.grains) {
    const double diameter_m = 2 * g.radius_m;
    sum += dem.grain_material.density_kg_m3 * sphere_m3(diameter_m) * 9.81 * diameter_m;
  }
  return sum;
}

void require_step(const BedSettings& bed, const DemSettings& dem) {
  const double rayleigh_s = rayleigh_time_s(dem.grain_material, bed.smallest_diameter_m() / 2);
  const double ratio = bed.settling_step_s() / rayleigh_s;
  if (ratio <= kLargestStepOverRayleigh) return;
  throw std::invalid_argument(
      "bed.settling_steps_per_ms = " + std::to_string(bed.settling_steps_per_ms) + ": a step is " +
      std::to_string(100 * ratio) +
      " % of the Rayleigh time of the smallest grain, must be at most " +
      std::to_string(int(100 * kLargestStepOverRayleigh)) + " %: at least " +
      std::to_string(int(std::ceil(1e-3 / (kLargestStepOverRayleigh * rayleigh_s)))));
}

}  // namespace

/// How a stage of settling goes and when it ends. The ratios are energy over lift energy.
struct BedMaking::Rule {
  std::string_view name;
  double viscous_rate_1_s;
  double rest_ratio;  // ends when the energy stays below
  double weight;      // of this stage in the whole work, for progress
};

// Measured on 45 x 45 x 120 mm of the paper's grains (8,600): steps of fall, calm, level and free
// 19,300 + 4,100 + 10,400 + 1,000; the solid share is that of beds settled in air for four times as
// long, within 0.002. The thin medium of the fall takes the speed of a long fall away; the stiff
// one of the calm, alone, would hold the grains up: free, they would begin to move again.
const BedMaking::Rule& BedMaking::rule(Stage stage) {
  static constexpr std::array<Rule, 6> kRules{{{"placing grains", 0, 0, 0.03},
                                               {"falling", 5, 2e-2, 0.55},
                                               {"calming", 300, 1e-4, 0.12},
                                               {"levelled, relaxing", 100, 2e-5, 0.27},
                                               {"free", 0, 1e-4, 0.03},
                                               {"made", 0, 0, 0}}};
  return kRules[std::size_t(stage)];
}

double rain_column_m(const BedSettings& bed) {
  return bed.depth_m * bed.overfill * kSettledShare / bed.rain_share;
}

BedMaking::BedMaking(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                     int threads)
    : settings_(bed),
      dem_(dem_settings(bed, materials, threads)),
      fall_s_(std::sqrt(2 * (rain_column_m(bed) - bed.depth_m) / 9.81)),
      rain_(bed, rain_column_m(bed), seed) {
  require_step(bed, dem_);
  dem_.dt_s = bed.settling_step_s();
}

std::string_view BedMaking::stage_name() const {
  return rule(stage_).name;
}

bool BedMaking::advance() {
  if (stage_ == Stage::kMade) return false;
  if (stage_ == Stage::kPlace) {
    constexpr std::size_t kGrains = 2000;
    if (!rain_.pour(kGrains)) begin(Stage::kFall);
  } else {
    settle();
  }
  double done = 0;
  for (int s = 0; s < int(stage_); ++s) done += rule(Stage(s)).weight;
  if (stage_ != Stage::kMade) done += rule(stage_).weight * stage_share();
  share_done_ = std::max(share_done_, std::min(1.0, done));
  return stage_ != Stage::kMade;
}

void BedMaking::begin(Stage stage) {
  stage_ = stage;
  stage_time_s_ = 0;
  highest_ratio_ = 0;
  quiet_pieces_ = 0;
  switch (stage) {
    case Stage::kFall:
      begin_fall();
      break;
    case Stage::kCalm:
      sand_->set_contact_pairs(dem_.grain_grain, dem_.grain_wall);  // all friction from here on
      break;
    case Stage::kLevel:
      begin_level();
      break;
    case Stage::kMade:
      state_ = sand_->state();
      sand_.reset();
      scrape(state_);  // what has risen since it was levelled
      number_from_zero(state_);
      return;
    case Stage::kPlace:
    case Stage::kFree:
      break;
  }
  sand_->set_viscous_rate(rule(stage).viscous_rate_1_s);
}

void BedMaking::begin_fall() {
  state_.grains = rain_.grains();
  make_sand(Stage::kFall);
}

void BedMaking::begin_level() {
  state_ = sand_->state();
  scrape(state_);
  make_sand(Stage::kLevel);
}

/// The sand of a stage, from state_.
void BedMaking::make_sand(Stage stage) {
  DemSettings settings = dem_;
  if (stage == Stage::kFall) {
    settings.grain_grain.static_friction = settings_.packing_friction;
    settings.grain_wall.static_friction = settings_.packing_friction;
    settings.grain_grain.rolling_friction = settings_.packing_rolling_friction;
    settings.grain_wall.rolling_friction =
        std::min(settings_.packing_rolling_friction, dem_.grain_wall.rolling_friction);
  }
  sand_ = std::make_unique<SandBed>(settings, state_);
  lift_energy_J_ = lift_energy_J(state_, dem_);
}

std::string BedMaking::snapshot() const {
  if (sand_ == nullptr) return {};
  ByteWriter w;
  w.put(stage_), w.put(stage_time_s_), w.put(highest_ratio_), w.put(energy_ratio_);
  w.put(quiet_pieces_), w.put(share_done_), w.put(steps_);
  put_state(w, state_);
  w.put_all(sand_->snapshot());
  return w.take();
}

void BedMaking::restore(std::string_view snapshot) {
  ByteReader r(snapshot);
  r.get(stage_), r.get(stage_time_s_), r.get(highest_ratio_), r.get(energy_ratio_);
  r.get(quiet_pieces_), r.get(share_done_), r.get(steps_);
  state_ = get_state(r);
  std::string sand;
  r.get_all(sand);
  if (!r.at_end()) throw std::runtime_error("bed: the snapshot is too long");
  make_sand(stage_);
  sand_->restore(sand);
  sand_->set_viscous_rate(rule(stage_).viscous_rate_1_s);
}

void BedMaking::settle() {
  sand_->advance(kPieceSteps);
  steps_ += kPieceSteps;
  stage_time_s_ += kPieceSteps * dem_.dt_s;
  energy_ratio_ = sand_->kinetic_energy_J() / lift_energy_J_;
  highest_ratio_ = std::max(highest_ratio_, energy_ratio_);

  const double limit = rule(stage_).rest_ratio;
  quiet_pieces_ = energy_ratio_ < limit ? quiet_pieces_ + 1 : 0;
  // The fall begins at rest and ends as soon as most have landed.
  const bool over = stage_ == Stage::kFall ? highest_ratio_ > limit && energy_ratio_ < limit
                                           : quiet_pieces_ >= kQuietPieces;
  if (over) return begin(Stage(int(stage_) + 1));
  // Ten times what the slowest of the measured stages took.
  const double patience_s = 10 * fall_s_;
  if (stage_time_s_ < patience_s) return;
  throw std::runtime_error(
      "bed: while " + std::string(rule(stage_).name) + " the grains do not come to rest in " +
      std::to_string(patience_s) + " s: their kinetic energy stays at " +
      std::to_string(energy_ratio_) + " of what lifts them by their diameters (bound " +
      std::to_string(limit) + "); a larger bed.settling_steps_per_ms may help");
}

double BedMaking::stage_share() const {
  if (stage_ == Stage::kPlace) return rain_.share_done();
  if (stage_ == Stage::kFall) return std::min(1.0, stage_time_s_ / (1.2 * fall_s_));
  if (!(energy_ratio_ > 0) || !(highest_ratio_ > rule(stage_).rest_ratio)) return 0;
  // What the media take away is a fixed share in a given time: even steps of the logarithm.
  return std::clamp(
      std::log(highest_ratio_ / energy_ratio_) / std::log(highest_ratio_ / rule(stage_).rest_ratio),
      0.0, 1.0);
}

BedState make_bed(const BedSettings& bed, const Materials& materials, std::uint64_t seed,
                  int threads, const BedProgress& progress) {
  BedMaking making(bed, materials, seed, threads);
  while (making.advance()) {
    if (progress && !progress(making.share_done())) throw std::runtime_error("stopped");
  }
  if (progress) progress(1);
  return making.bed();
}

}  // namespace hoof::sim
