#include "tools/reproduce/variation.h"

#include <cmath>

#include "tools/experiment/run_settings.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Grains over those of the preset, with the step that they need. An exchange interval of 25 us is
/// a whole number of steps.
Variation grains(const std::string& name, double factor, const std::vector<std::string>& settings) {
  const sim::BedSettings bed = read_run_settings("sinkage", settings).bed;
  const double scale = std::round(1e6 * factor * bed.grain_scale) / 1e6;  // 2.88, not 2.8800...03
  Variation v{name,
              "grain size",
              "grains " + format_number(factor) + " times as large, " + format_number(scale) +
                  " times the paper's",
              {},
              {},
              {},
              {}};
  v.of_all = {"bed.grain_scale_ratio=" + format_number(scale)};
  if (factor < 1) {
    constexpr double kPerExchange = 40;
    const double steps = std::ceil(bed.steps_per_ms / factor / kPerExchange) * kPerExchange;
    const double settling = std::ceil(bed.settling_steps_per_ms / factor);
    v.of_all.push_back("bed.steps_per_ms=" + format_number(steps));
    v.of_all.push_back("bed.settling_steps_per_ms=" + format_number(settling));
  }
  return v;
}

Variation valley(const std::string& name, const ValleyPoint& p) {
  Variation v{name,
              "calibration",
              "restitution " + format_number(p.restitution) + ", rolling friction " +
                  format_number(p.rolling_friction) + ", static friction " +
                  format_number(p.static_friction) +
                  " between grains: the same angle of repose by the paper's own fit",
              {},
              {},
              {},
              {}};
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

std::vector<std::string> Variation::changes(const std::string& foot) const {
  std::vector<std::string> all = of_all;
  if (foot == "bionic") append(all, of_spined);
  append(all, foot == "traditional" ? of_sole : of_toed);
  return all;
}

std::vector<Variation> claim_variations(const std::vector<std::string>& settings) {
  // The ranges that sim/config/feet state.
  Variation shorter{"short-spines",
                    "geometry",
                    "spines 8 mm long in place of 10 (range 8 to 14)",
                    {"foot.spines.length_mm=8"},
                    {},
                    {},
                    {}};
  Variation longer{"long-spines",
                   "geometry",
                   "spines 14 mm long in place of 10 (range 8 to 14)",
                   {"foot.spines.length_mm=14"},
                   {},
                   {},
                   {}};
  Variation soles{
      "other-soles",
      "geometry",
      "toes 20 mm wide in place of 25, the traditional sole 50 mm in place of 40 (range "
      "35 to 55): 1.5 times its area for 2.0",
      {},
      {"foot.toe.width_mm=20"},
      {"foot.middle.width_mm=50"},
      {}};
  std::vector<Variation> all = {shorter, longer, soles, grains("fine-grains", 0.8, settings),
                                grains("coarse-grains", 1.25, settings)};
  int n = 0;
  for (const ValleyPoint& point : valley_points()) {
    all.push_back(valley("valley" + std::to_string(++n), point));
  }
  return all;
}

const std::vector<std::string>& variation_names() {
  static const std::vector<std::string> names = {"short-spines", "long-spines",   "other-soles",
                                                 "fine-grains",  "coarse-grains", "valley1",
                                                 "valley2",      "valley3"};
  return names;
}

Cell varied(const Cell& cell, const Variation& variation) {
  Cell other = cell;
  other.changes = variation.changes(cell.foot);
  if (!other.changes.empty()) other.variation = variation.name;
  return other;
}

}  // namespace hoof::tools
