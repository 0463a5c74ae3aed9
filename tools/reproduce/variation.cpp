#include "tools/reproduce/variation.h"

#include <cmath>

#include "sim/config/reader.h"
#include "sim/terrain/bed_settings.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// The bed alone: whether a kind of run that nobody asked for could be made on it is not asked
/// here.
sim::BedSettings bed_of(const CampaignSettings& settings, const std::string& kind) {
  const auto tree = sim::Settings::load_experiment(kind, settings.ground_of(kind));
  return sim::read_bed(sim::Reader(tree).section("bed"));
}

double grain_scale(const sim::BedSettings& bed, double factor) {
  return std::round(1e6 * factor * bed.grain_scale) / 1e6;  // 2.88, not 2.8800...03
}

/// Grains `factor` times as large, with the step that they need. An exchange interval of 25 us is a
/// whole number of steps.
std::vector<std::string> scaled(const sim::BedSettings& bed, double factor) {
  std::vector<std::string> all = {"bed.grain_scale_ratio=" +
                                  format_number(grain_scale(bed, factor))};
  if (factor < 1) {
    constexpr double kPerExchange = 40;
    const double steps = std::ceil(bed.steps_per_ms / factor / kPerExchange) * kPerExchange;
    const double settling = std::ceil(bed.settling_steps_per_ms / factor);
    all.push_back("bed.steps_per_ms=" + format_number(steps));
    all.push_back("bed.settling_steps_per_ms=" + format_number(settling));
  }
  return all;
}

Variation grains(const std::string& name, double factor, const CampaignSettings& settings) {
  const sim::BedSettings sinkage = bed_of(settings, "sinkage");
  const sim::BedSettings traction = bed_of(settings, "traction");
  const double scale = grain_scale(sinkage, factor), other = grain_scale(traction, factor);
  Variation v{.name = name,
              .kind = "grain size",
              .what = "grains " + format_number(factor) + " times as large, " +
                      format_number(scale) + " times the paper's"};
  if (other != scale) v.what += ", under a traction " + format_number(other) + " times";
  v.of_sinkage = scaled(sinkage, factor);
  v.of_traction = scaled(traction, factor);
  return v;
}

Variation twice_as_deep(const CampaignSettings& settings) {
  const auto deep = [&](const std::string& kind) {
    return std::vector<std::string>{"bed.depth_mm=" +
                                    format_number(2e3 * bed_of(settings, kind).depth_m)};
  };
  return {.name = "deep-bed",
          .kind = "box",
          .what = "a bed twice as deep: the floor carries less",
          .of_sinkage = deep("sinkage"),
          .of_traction = deep("traction")};
}

Variation valley(const std::string& name, const ValleyPoint& p) {
  Variation v{.name = name,
              .kind = "calibration",
              .what = "restitution " + format_number(p.restitution) + ", rolling friction " +
                      format_number(p.rolling_friction) + ", static friction " +
                      format_number(p.static_friction) +
                      " between grains: the same angle of repose by the paper's own fit"};
  const std::string pair = "materials.sand_sand.";
  v.of_all = {pair + "restitution.value=" + format_number(p.restitution),
              pair + "rolling_friction.value=" + format_number(p.rolling_friction),
              pair + "static_friction.value=" + format_number(p.static_friction)};
  return v;
}

}  // namespace

const std::vector<ValleyPoint>& valley_points() {
  // hoof anova of the paper's table 2: valley.csv. 37.82, 37.86 and 37.81 degrees by its fit, for
  // 37.79 of the paper's own triple.
  static const std::vector<ValleyPoint> points = {
      {0.15, 0.362, 0.55}, {0.54, 0.254, 0.85}, {0.80, 0.346, 0.60}};
  return points;
}

std::vector<std::string> Variation::changes(const Cell& cell) const {
  std::vector<std::string> all = of_all;
  if (cell.foot == "bionic") append(all, of_spined);
  append(all, cell.foot == "traditional" ? of_sole : of_toed);
  append(all, cell.traction ? of_traction : of_sinkage);
  return all;
}

std::vector<Variation> claim_variations(const CampaignSettings& settings) {
  // The ranges that sim/config/feet state.
  std::vector<Variation> all = {
      {.name = "short-spines",
       .kind = "geometry",
       .what = "spines 8 mm long in place of 10 (range 8 to 14)",
       .of_spined = {"foot.spines.length_mm=8"}},
      {.name = "long-spines",
       .kind = "geometry",
       .what = "spines 14 mm long in place of 10 (range 8 to 14)",
       .of_spined = {"foot.spines.length_mm=14"}},
      {.name = "other-soles",
       .kind = "geometry",
       .what = "toes 20 mm wide in place of 25, the traditional sole 50 mm in place of 40 (range "
               "35 to 55): 1.5 times its area for 2.0",
       .of_toed = {"foot.toe.width_mm=20"},
       .of_sole = {"foot.middle.width_mm=50"}},
      grains("fine-grains", 0.8, settings),
      grains("coarse-grains", 1.25, settings)};
  int n = 0;
  for (const ValleyPoint& point : valley_points()) {
    all.push_back(valley("valley" + std::to_string(++n), point));
  }
  return all;
}

std::vector<Variation> all_variations(const CampaignSettings& settings) {
  std::vector<Variation> all = claim_variations(settings);
  const std::vector<Variation> more = {
      {.name = "loose-sand",
       .kind = "packing",
       .what = "all friction acts while the grains fall: a solid share of 0.56 for 0.60 (the paper "
               "does not say how its bed was packed)",
       .of_all = {"bed.packing_rolling_friction=0.34"}},
      twice_as_deep(settings),
      {.name = "elastic-cap",
       .kind = "law",
       .what = "friction capped by mu times the elastic part of the normal force, as the paper "
               "prints it",
       .of_all = {"bed.coulomb_cap=elastic"}},
      {.name = "relative-spin",
       .kind = "law",
       .what = "rolling friction on the spin of two grains against each other, not on each one's",
       .of_all = {"bed.rolling_law=relative_spin"}},
      {.name = "block-load",
       .kind = "load",
       .what = "the load is a block's mass, not a force (the paper does not say which)",
       .of_sinkage = {"experiment.load_as=mass"}},
      {.name = "light-foot",
       .kind = "load",
       .what = "a foot of 1.1 kg in place of 1.5 (range 1.0 to 2.1)",
       .of_all = {"foot.mass_kg=1.1"}},
      {.name = "exact-path",
       .kind = "path",
       .what = "the foot follows its path exactly, as in the paper, without drives and control",
       .of_traction = {"experiment.drive=prescribed"}},
      {.name = "deeper-path",
       .kind = "path",
       .what = "the middle of the sole goes 8 mm deep in place of 5 (the paper gives no path)",
       .of_traction = {"experiment.ellipse_centre_height_mm=12"}},
      {.name = "shallower-path",
       .kind = "path",
       .what = "the middle of the sole goes 2 mm deep in place of 5 (the paper gives no path)",
       .of_traction = {"experiment.ellipse_centre_height_mm=18"}}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const std::vector<std::string>& claim_variation_names() {
  static const std::vector<std::string> names = {"short-spines", "long-spines",   "other-soles",
                                                 "fine-grains",  "coarse-grains", "valley1",
                                                 "valley2",      "valley3"};
  return names;
}

const std::vector<std::string>& variation_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = claim_variation_names();
    append(all, {"loose-sand", "deep-bed", "elastic-cap", "relative-spin", "block-load",
                 "light-foot", "exact-path", "deeper-path", "shallower-path"});
    return all;
  }();
  return names;
}

Cell varied(const Cell& cell, const Variation& variation) {
  Cell other = cell;
  other.changes = variation.changes(cell);
  if (!other.changes.empty()) other.variation = variation.name;
  return other;
}

Outcomes unchanged(const Outcomes& base, const Variation& variation) {
  Outcomes same;
  for (const auto& [condition, beds] : base) {
    if (varied(cell_of(condition), variation).variation.empty()) same[condition] = beds;
  }
  return same;
}

}  // namespace hoof::tools
