// Does a bed resolve spines or opened toes? The two bodies of a pair go down in the same beds, so
// that what the beds have in common drops out of their ratio.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tools/run/errors.h"
#include "tools/study/statistics.h"
#include "tools/study/study_bench.h"

namespace hoof::tools {
namespace {

/// Within the paper's sinkages at 10 to 40 kg.
constexpr double kDepths_m[] = {5e-3, 8e-3, 13e-3};
/// Effects as large as the paper's of the spines (14 to 17 %) and of the opening (5 to 20 %).
constexpr double kEffects[] = {0.10, 0.15};
constexpr double kBoxDepth_m = 0.1;  // as beds/bench.toml
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Group {
  std::string body;  // as printed
  std::string effect;
  double scale = 1;
  Box box;
  double area_m2 = 0;        // of the plain sole, as pressed
  PressCase plain, changed;  // seeds are set later
};

double sole_area_m2(const sim::FootGeometry& g) {
  const double toe_m2 = 0.5 * (g.toe.width_m + g.toe.tip_width_m) * g.toe.length_m;
  return g.middle.length_m * g.middle.width_m + (g.has_toes ? 2 * toe_m2 : 0);
}

class ResolutionStudy {
 public:
  explicit ResolutionStudy(const StudyOptions& options)
      : bench_("resolution", options),
        scales_(options.scales),
        lengths_mm_(options.lengths_mm),
        bodies_(options.bodies),
        bed_count_(options.bed_count.value_or(5)) {
    if (scales_.empty()) scales_ = {3.6, 2.1};
    if (options.scales.empty() && options.full) scales_ = {3.6, 2.1, 1.5, 1};
    if (lengths_mm_.empty()) lengths_mm_ = {160};
    if (options.lengths_mm.empty() && options.full) lengths_mm_ = {160, 240};
    if (bodies_.empty()) bodies_ = {"strip"};
    if (options.bodies.empty() && options.full) bodies_ = {"strip", "mirror", "foot"};
    std::sort(scales_.begin(), scales_.end(), std::greater<>());  // the cheap ones first
  }

  void go() {
    for (const double scale : scales_) {
      for (const std::string& body : bodies_) {
        if (body == "strip") add_strips(scale);
        if (body == "mirror") add_mirrors(scale);
        if (body == "foot") add_feet(scale);
      }
    }
    run();
    report();
  }

 private:
  PressCase pressing(const sim::BedSettings& bed, const Indenter& indenter) const {
    PressCase c;
    c.bed = bed;
    c.indenter = indenter;
    c.speed_m_s = bench_.settings().sinkage.speed_m_s;
    return c;
  }

  void add(Group group, const sim::BedSettings& bed, const Indenter& plain,
           const Indenter& changed) {
    group.plain = pressing(bed, plain);
    group.changed = pressing(bed, changed);
    groups_.push_back(std::move(group));
  }

  void add_strips(double scale) {
    const sim::FootGeometry& g = bench_.settings().foot.geometry;
    for (const double length_mm : lengths_mm_) {
      const Box box{length_mm * 1e-3, bench_.slice_m(scale), kBoxDepth_m};
      add({"strip", "spines", scale, box, box.width_m * g.middle.width_m, {}, {}},
          bench_.bed(scale, box, true), make_strip(g, box.width_m, false),
          make_strip(g, box.width_m, true));
    }
  }

  /// Half of a strip against a frictionless wall through its middle, beside the whole strip, both
  /// between frictionless walls: what the mirror plane alone does.
  void add_mirrors(double scale) {
    const sim::FootGeometry& g = bench_.settings().foot.geometry;
    for (const double length_mm : lengths_mm_) {
      const Box whole{length_mm * 1e-3, bench_.slice_m(scale), kBoxDepth_m};
      const Box half{whole.length_m / 2, whole.width_m, whole.depth_m};
      const Indenter plain = make_strip(g, whole.width_m, false);
      const Indenter spined = make_strip(g, whole.width_m, true);
      const double area_m2 = whole.width_m * g.middle.width_m;
      add({"smooth strip", "spines", scale, whole, area_m2, {}, {}},
          bench_.bed(scale, whole, false), plain, spined);
      groups_.back().plain.smooth = groups_.back().changed.smooth = true;
      if (half.length_m < 6 * scale * bench_.settings().bed.largest_diameter_m()) continue;
      add({"half at a mirror", "spines", scale, half, area_m2 / 2, {}, {}},
          bench_.bed(scale, half, false), plain, spined);
      for (PressCase* c : {&groups_.back().plain, &groups_.back().changed}) {
        c->smooth = true;
        c->offset_x_m = -half.length_m / 2;
      }
    }
  }

  /// Spines with the toes closed, and the toes opened without spines, in the box of the settings.
  void add_feet(double scale) {
    const sim::Foot& foot = bench_.settings().foot;
    const sim::BedSettings& b = bench_.settings().bed;
    const Box box{b.box_length_m, b.box_width_m, b.depth_m};
    const sim::BedSettings bed = bench_.bed(scale, box, b.periodic_sides);
    const Indenter plain = make_foot(foot, 0, false);
    const double area_m2 = sole_area_m2(foot.geometry);
    add({"foot", "spines", scale, box, area_m2, {}, {}}, bed, plain, make_foot(foot, 0, true));
    const double open_rad = bench_.settings().toe_rad();
    if (open_rad == 0) return;
    const int open_deg = int(std::lround(open_rad * 180 / std::numbers::pi));
    add({"foot", "toes " + std::to_string(open_deg) + " deg", scale, box, area_m2, {}, {}}, bed,
        plain, make_foot(foot, open_rad, false));
  }

  void run() {
    std::vector<PressCase> cases;
    for (const Group& g : groups_) {
      // Seed by seed, plain then changed: after Ctrl-C whole pairs are there.
      const auto plain = bench_.over_seeds(g.plain, bed_count_);
      const auto changed = bench_.over_seeds(g.changed, bed_count_);
      for (std::size_t i = 0; i < plain.size(); ++i) {
        cases.push_back(plain[i]);
        cases.push_back(changed[i]);
      }
    }
    const std::vector<PressCurve> curves = bench_.runner().run("resolution", cases);
    for (std::size_t i = 0; i < curves.size(); i += 2) {
      if (i % std::size_t(2 * bed_count_) == 0) plain_.emplace_back(), changed_.emplace_back();
      plain_.back().push_back(curves[i]);
      changed_.back().push_back(curves[i + 1]);
    }
  }

  /// Mean pressure under the plain sole of the finest grains with the same body and box length.
  double finest_Pa(const Group& like, double depth_m) const {
    double scale = std::numeric_limits<double>::infinity(), pressure_Pa = kNaN;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const Group& other = groups_[g];
      if (other.body != like.body || other.effect != like.effect ||
          other.box.length_m != like.box.length_m || other.scale >= scale) {
        continue;
      }
      scale = other.scale;
      pressure_Pa = forces(plain_[g], depth_m).mean / other.area_m2;
    }
    return pressure_Pa;
  }

  static Sample forces(const std::vector<PressCurve>& curves, double depth_m) {
    std::vector<double> values;
    for (const PressCurve& c : curves) values.push_back(c.force_at_N(depth_m));
    return sample_of(values);
  }

  /// @param raised_m the changed body's sole is this much higher than the plain one's
  static Sample ratios(const std::vector<PressCurve>& plain, const std::vector<PressCurve>& changed,
                       double depth_m, double raised_m) {
    std::vector<double> values;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      values.push_back(changed[i].force_at_N(depth_m - raised_m) / plain[i].force_at_N(depth_m));
    }
    return sample_of(values);
  }

  static std::string verdict(const Sample& ratio) {
    for (const double effect : kEffects) {
      if (ratio.confidence <= effect) return std::to_string(int(effect * 100)) + " %";
    }
    return "no";
  }

  void report() {
    Table table({{"grain_scale_ratio", 1},
                 {"d50_mm", 2},
                 {"body_name"},
                 {"box_mm_name"},
                 {"grain_count"},
                 {"solid_share_ratio", 3},
                 {"bed_count"},
                 {"effect_name"},
                 {"depth_mm", 0},
                 {"pressure_Pa", 0},
                 {"scatter_ratio", 3},
                 {"pressure_over_finest_ratio", 2},
                 {"effect_ratio", 3},
                 {"standard_error_ratio", 3},
                 {"above_one_count"},
                 {"confidence_ratio", 3},
                 {"resolves_name"},
                 {"same_travel_ratio", 2}});
    std::vector<PlotLine> lines;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (const double depth_m : kDepths_m) table.row(row(g, depth_m));
      const Group& group = groups_[g];
      const std::string label =
          group.body + " " + group.box.text() + ", d50 " + number(group.plain.bed.d50_m() * 1e3);
      if (group.effect == "spines") {
        lines.push_back(mean_line(label + " mm", plain_[g], group.area_m2, int(g), false));
      }
      lines.push_back(mean_line(group.effect, changed_[g], group.area_m2, int(g), true));
    }
    bench_.finish(notes(), table, "Mean pressure; dashed: the changed body", "kPa", lines);
  }

  std::vector<Table::Cell> row(std::size_t g, double depth_m) const {
    const Group& group = groups_[g];
    const Sample plain = forces(plain_[g], depth_m);
    const Sample ratio = ratios(plain_[g], changed_[g], depth_m, 0);
    const double spine_m = -group.changed.indenter.lowest_m();
    const Sample travel = ratios(plain_[g], changed_[g], depth_m, spine_m);
    const double pressure_Pa = plain.mean / group.area_m2;
    return {group.plain.bed.grain_scale,
            group.plain.bed.d50_m() * 1e3,
            group.body,
            group.box.text(),
            std::int64_t(plain_[g].front().grain_count),
            plain_[g].front().solid_share,
            std::int64_t(ratio.n),
            group.effect,
            depth_m * 1e3,
            pressure_Pa,
            plain.deviation / plain.mean,
            pressure_Pa / finest_Pa(group, depth_m),
            ratio.mean,
            ratio.standard_error,
            std::int64_t(ratio.above_one),
            ratio.confidence,
            verdict(ratio),
            spine_m > 0 ? travel.mean : kNaN};
  }

  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
  }

  std::string notes() const {
    const sim::BedSettings& b = bench_.settings().bed;
    char text[900];
    std::snprintf(
        text, sizeof text,
        "Pressed at %g m/s, step %.2f us times the grain scale, beds of seeds %lld to %lld.\n"
        "effect: force on the changed body over that on the plain one in the same bed, mean over\n"
        "the beds, at the same depth of the sole (means over +-0.5 mm); same travel: from each\n"
        "body's own first contact. scatter: standard deviation of the plain force from bed to bed\n"
        "over its mean. confidence: half of the 95 %% interval of the effect; a smaller "
        "difference\n"
        "cannot be seen with so many beds, and 'resolves' says which effects can.\n",
        bench_.settings().sinkage.speed_m_s, 1e3 / b.steps_per_ms,
        static_cast<long long>(bench_.options().seed),
        static_cast<long long>(bench_.options().seed + bed_count_ - 1));
    return text;
  }

  StudyBench bench_;
  std::vector<double> scales_, lengths_mm_;
  std::vector<std::string> bodies_;
  int bed_count_;
  std::vector<Group> groups_;
  std::vector<std::vector<PressCurve>> plain_, changed_;  // per group, per bed
};

}  // namespace

void run_resolution_study(const StudyOptions& options) {
  ResolutionStudy(options).go();
}

}  // namespace hoof::tools
