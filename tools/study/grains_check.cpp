// Each cause in grains, one seed a bed: the spines shortened in the same beds, the walls moved
// nearer, the floor, which is the firmest of layers, brought up. On fast soil the catalogue's
// effect; a strength that no geometry tells is set so that both agree at the deepest depth, and the
// others are the check.

#include "tools/study/grains_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "tools/run/errors.h"
#include "tools/study/fast_press.h"
#include "tools/study/study_bench.h"

namespace hoof::tools {
namespace {

/// Of the sole; at the first one only the spines are in the sand.
constexpr double kDepths_m[] = {-2e-3, 5e-3, 8e-3, 13e-3};
constexpr double kDeepest_m = 13e-3;
constexpr double kFar_m = 0.24, kNear_m = 0.08;  // length of the box, across the strip
constexpr double kDeep_m = 0.1, kFirm_m = 0.04;  // depth of the floor
constexpr double kLoss_m = 4e-3;                 // of the spines
constexpr double kLayerRatio = 3;                // stiffness below a layer whose depth is fitted
/// What is smaller on fast soil is none.
constexpr double kNoChange = 1e-3;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

double whole_cm(double least_m) {
  return std::ceil(least_m * 100 - 1e-6) / 100;
}

struct Pair {
  GrainsCase what;
  double scale = 1;
  PressCase without, with;   // in grains
  SoilEffectChoice effect;   // on fast soil; a fitted value is set later
  int fitted = -1;           // which of its values
  double low = 0, high = 0;  // of that
  std::vector<PressCurve> plain, changed;
};

class GrainsCheck {
 public:
  explicit GrainsCheck(const StudyOptions& options)
      : bench_("grains-check", options),
        scales_(options.scales),
        bed_count_(options.bed_count.value_or(options.full ? 5 : 3)) {
    if (scales_.empty()) scales_ = {options.full ? 1.0 : 1.5};
  }

  void go(const std::vector<GrainsCase>& cases) {
    for (const double scale : scales_) {
      for (const GrainsCase& what : cases) {
        if (what.possible) pairs_.push_back(pair(what, scale));
      }
    }
    std::vector<PressCase> presses;
    for (const Pair& p : pairs_) {
      for (const PressCase* c : {&p.without, &p.with}) {
        for (const PressCase& one : bench_.over_seeds(*c, bed_count_)) presses.push_back(one);
      }
    }
    const auto curves = bench_.runner().run("grains", presses);
    auto next = curves.begin();
    for (Pair& p : pairs_) {
      p.plain.assign(next, next + bed_count_);
      p.changed.assign(next + bed_count_, next + 2 * bed_count_);
      next += 2 * bed_count_;
    }
    report(cases);
  }

 private:
  PressCase pressing(double scale, const Box& box, double spine_loss_m) const {
    const sim::Foot foot = sim::with_worn_spines(bench_.settings().foot, spine_loss_m);
    PressCase c;
    c.bed = bench_.bed(scale, box, false);
    c.indenter = make_strip(foot.geometry, box.width_m, true);
    c.speed_m_s = bench_.settings().sinkage.speed_m_s;
    return c;
  }

  Pair pair(const GrainsCase& what, double scale) const {
    const double largest_m = scale * bench_.settings().bed.largest_diameter_m();
    const Box far{std::max(kFar_m, whole_cm(9 * largest_m)), bench_.slice_m(scale),
                  std::max(kDeep_m, whole_cm(6 * largest_m))};
    Box near = far, firm = far;
    near.length_m = std::max(kNear_m, whole_cm(6 * largest_m));
    firm.depth_m = std::max(kFirm_m, whole_cm(4 * largest_m));
    Pair p{what, scale, pressing(scale, far, 0), {}, {what.effect, {}}, -1, 0, 0, {}, {}};
    if (what.effect == "wall_confinement") {
      p.with = pressing(scale, near, 0);
      p.effect.values = {0};
      p.fitted = 0, p.low = 1e-2, p.high = 1e3;
    } else if (what.effect == "hard_layer") {
      p.with = pressing(scale, firm, 0);
      p.effect.values = {firm.depth_m, kLayerRatio};
      p.fitted = 0, p.low = 1e-3, p.high = firm.depth_m;
    } else {
      p.with = pressing(scale, far, kLoss_m);
      p.effect = {};  // the spines themselves are shorter
    }
    return p;
  }

  double fast_change(const Pair& p, double depth_m, const SoilEffectChoice& effect) const {
    const sim::RftTerrainSettings& soil = bench_.settings().rft;
    return press_fast_soil(p.with, soil, effect).force_at_N(depth_m) /
               press_fast_soil(p.without, soil, {}).force_at_N(depth_m) -
           1;
  }

  static Sample grains_change(const Pair& p, double depth_m) {
    std::vector<double> changes;
    for (std::size_t i = 0; i < p.plain.size(); ++i) {
      changes.push_back(p.changed[i].force_at_N(depth_m) / p.plain[i].force_at_N(depth_m) - 1);
    }
    return sample_of(changes);
  }

  /// The strength that makes the change of the grains at the deepest depth.
  void fit(Pair& p) const {
    if (p.fitted < 0) return;
    const auto at = [&](double value) {
      SoilEffectChoice effect = p.effect;
      effect.values[std::size_t(p.fitted)] = value;
      return fast_change(p, kDeepest_m, effect);
    };
    p.effect.values[std::size_t(p.fitted)] =
        solve_monotone(at, grains_change(p, kDeepest_m).mean, p.low, p.high);
  }

  std::string on_fast_soil(const Pair& p) const {
    char text[100];
    if (p.what.effect == "wall_confinement") {
      std::snprintf(text, sizeof text, "coefficient %.3g fitted", p.effect.values[0]);
    } else if (p.what.effect == "hard_layer") {
      std::snprintf(text, sizeof text, "%.3g mm fitted and %g times", p.effect.values[0] * 1e3,
                    p.effect.values[1]);
    } else {
      std::snprintf(text, sizeof text, "loss %g mm", kLoss_m * 1e3);
    }
    return text;
  }

  std::string in_grains(const Pair& p) const {
    char text[100];
    const sim::BedSettings &a = p.without.bed, &b = p.with.bed;
    if (p.what.effect == "wall_confinement") {
      std::snprintf(text, sizeof text, "walls %g mm apart for %g", b.box_length_m * 1e3,
                    a.box_length_m * 1e3);
    } else if (p.what.effect == "hard_layer") {
      std::snprintf(text, sizeof text, "rigid floor at %g mm for %g", b.depth_m * 1e3,
                    a.depth_m * 1e3);
    } else {
      std::snprintf(text, sizeof text, "spines shorter by %g mm", kLoss_m * 1e3);
    }
    return text;
  }

  void report(const std::vector<GrainsCase>& cases) {
    Table table({{"case_name"},
                 {"in_grains_name"},
                 {"on_fast_soil_name"},
                 {"d50_mm", 1},
                 {"bed_count"},
                 {"depth_mm", 0},
                 {"grains_without_N", 1},
                 {"grains_change_ratio", 3},
                 {"grains_half_95_ratio", 3},
                 {"fast_soil_change_ratio", 3},
                 {"sign_agrees_name"},
                 {"fast_over_grains_ratio", 2}});
    std::vector<PlotLine> lines;
    for (Pair& p : pairs_) {
      fit(p);
      for (const double depth_m : kDepths_m) table.row(row(p, depth_m));
      const int colour = int(&p - pairs_.data());
      lines.push_back(change_line(p, colour, true));
      lines.push_back(change_line(p, colour, false));
    }
    std::string text = notes();
    for (const Pair& p : pairs_) {
      for (const auto* curves : {&p.plain, &p.changed}) {
        for (const PressCurve& c : *curves) {
          if (!c.blow_up.empty()) text += p.what.name + ": a bed blew up: " + c.blow_up + "\n";
        }
      }
    }
    for (const GrainsCase& c : cases) {
      if (!c.possible) text += c.name + " (" + c.effect + "): not checked: " + c.cause + "\n";
    }
    bench_.finish(text, table, "Force with the cause over that without; dashed: fast soil",
                  "ratio, 1", lines);
  }

  std::vector<Table::Cell> row(const Pair& p, double depth_m) const {
    std::vector<double> without;
    for (const PressCurve& c : p.plain) without.push_back(c.force_at_N(depth_m));
    const GrainsChange change{grains_change(p, depth_m), fast_change(p, depth_m, p.effect),
                              p.fitted >= 0 && depth_m == kDeepest_m};
    return {p.what.name,
            in_grains(p),
            on_fast_soil(p),
            p.without.bed.d50_m() * 1e3,
            std::int64_t(change.grains.n),
            depth_m * 1e3,
            sample_of(without).mean,
            change.grains.mean,
            change.grains.confidence,
            change.fast,
            change.sign_agrees(),
            change.size_ratio()};
  }

  PlotLine change_line(const Pair& p, int colour, bool fast) const {
    PlotLine line{p.what.name + (fast ? ", fast soil" : ", grains"), {}, colour, fast};
    constexpr double kFirst_m = -3e-3, kWay_m = 1e-3;
    for (double depth_m = kFirst_m; depth_m < kDeepest_m + 0.5 * kWay_m; depth_m += kWay_m) {
      const double change =
          fast ? fast_change(p, depth_m, p.effect) : grains_change(p, depth_m).mean;
      if (std::isfinite(change)) line.points.emplace_back(depth_m * 1e3, 1 + change);
    }
    return line;
  }

  std::string notes() const {
    char text[900];
    std::snprintf(
        text, sizeof text,
        "A strip of the spined sole pressed at %g m/s, beds of seeds %lld to %lld, between walls;\n"
        "fast soil %s. Change: force with the cause over that without, less 1, at that depth of\n"
        "the sole. half 95: of its interval over beds. What is fitted agrees at %g mm by being "
        "set so;\nthe other depths are the check.\n",
        bench_.settings().sinkage.speed_m_s, static_cast<long long>(bench_.options().seed),
        static_cast<long long>(bench_.options().seed + bed_count_ - 1),
        bench_.settings().rft.name.c_str(), kDeepest_m * 1e3);
    return text;
  }

  StudyBench bench_;
  std::vector<double> scales_;
  int bed_count_;
  std::vector<Pair> pairs_;
};

}  // namespace

const std::vector<GrainsCase>& grains_cases() {
  static const std::vector<GrainsCase> cases = {
      {"worn-spines", "spine_wear", "shorter spines in the same beds"},
      {"wall-near", "wall_confinement", "walls nearer to the strip"},
      {"firm-layer", "hard_layer", "the floor, the firmest of layers, brought up"},
      {"cohesive-sand", "cohesion", "the grains' contact law pulls on nothing: no adhesion", false},
      {"layered-sand", "hard_layer",
       "a bed has one kind of grain and one packing; firm-layer is what it can have", false}};
  return cases;
}

bool GrainsChange::told() const {
  return grains.n > 1 && std::abs(grains.mean) > grains.confidence;
}

std::string GrainsChange::sign_agrees() const {
  if (!told()) return "not told";
  if (fitted) return "fitted here";
  if (std::abs(fast) < kNoChange) return "no effect on fast soil";
  return (fast > 0) == (grains.mean > 0) ? "yes" : "no";
}

double GrainsChange::size_ratio() const {
  return told() ? fast / grains.mean : kNaN;
}

void run_grains_check(const StudyOptions& options) {
  std::vector<GrainsCase> chosen;
  std::string known;
  for (const GrainsCase& c : grains_cases()) {
    const auto& only = options.bodies;
    if (only.empty() || std::find(only.begin(), only.end(), c.name) != only.end()) {
      chosen.push_back(c);
    }
    known += (known.empty() ? "" : ", ") + c.name;
  }
  for (const std::string& name : options.bodies) {
    const bool there = std::any_of(chosen.begin(), chosen.end(),
                                   [&name](const GrainsCase& c) { return c.name == name; });
    if (!there) throw UserError("--only " + name + ": no such case; there are " + known);
  }
  StudyOptions own = options;
  // Twice the paper's speed and step: the same forces within the scatter (RESOLUTION.md).
  own.settings = {"bed.steps_per_ms=180", "experiment.speed_m_s=0.2"};
  own.settings.insert(own.settings.end(), options.settings.begin(), options.settings.end());
  GrainsCheck(own).go(chosen);
}

}  // namespace hoof::tools
