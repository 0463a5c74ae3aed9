// How large must the box be? The same body in boxes of growing length and width, and of growing
// depth, against the largest.

#include <cmath>
#include <cstdio>
#include <vector>

#include "tools/experiment/bench.h"
#include "tools/experiment/foot_plan.h"
#include "tools/study/statistics.h"
#include "tools/study/study_bench.h"

namespace hoof::tools {
namespace {

constexpr double kDepths_m[] = {5e-3, 8e-3, 13e-3};
// Strip of 40 mm: boxes of 2 to 16 times its width, and 1.5 to 5 times as deep.
constexpr double kStripLengths_mm[] = {80, 120, 160, 240, 320, 480, 640};
constexpr double kStripDepths_mm[] = {60, 100, 150, 200};
constexpr double kStripDepth_mm = 100, kStripLength_mm = 240;
// Boxes over the footprint of the foot in x and y; 3 x 4.6 is the paper's box for closed toes.
constexpr double kFootFactors[] = {1.5, 2, 3, 4, 5};
constexpr double kFootDepths_mm[] = {100, 120, 180, 240};
constexpr double kFootDepth_mm = 120, kFootFactor = 3;

struct Series {
  std::string body;
  std::string varied;
  std::vector<PressCase> boxes;  // the last is what the others are compared with
  double foot_x_m = 0, foot_y_m = 0, area_m2 = 0;
};

class BoxStudy {
 public:
  explicit BoxStudy(const StudyOptions& options)
      : bench_("box", options), bodies_(options.bodies), bed_count_(options.bed_count.value_or(3)) {
    if (bodies_.empty()) bodies_ = {"strip"};
    if (options.bodies.empty() && options.full) bodies_ = {"strip", "foot"};
  }

  void go() {
    for (const std::string& body : bodies_) {
      if (body == "strip") add_strip(scale_or(2.1));
      if (body == "foot") add_foot(scale_or(3.6));
    }
    std::vector<PressCase> cases;
    for (const Series& s : series_) {
      for (const PressCase& c : s.boxes) {
        const auto beds = bench_.over_seeds(c, bed_count_);
        cases.insert(cases.end(), beds.begin(), beds.end());
      }
    }
    curves_ = bench_.runner().run("box", cases);
    report();
  }

 private:
  double scale_or(double own) const {
    return bench_.options().scales.empty() ? own : bench_.options().scales.front();
  }

  PressCase pressing(double scale, const Box& box, bool periodic, const Indenter& indenter) const {
    PressCase c;
    c.bed = bench_.bed(scale, box, periodic);
    c.indenter = indenter;
    c.speed_m_s = bench_.settings().sinkage.speed_m_s;
    return c;
  }

  void add_strip(double scale) {
    const sim::FootGeometry& g = bench_.settings().foot.geometry;
    const double slice_m = bench_.slice_m(scale);
    const Indenter strip = make_strip(g, slice_m, false);
    const double least_mm = 6e3 * scale * bench_.settings().bed.largest_diameter_m();
    Series length{"strip", "length", {}, g.middle.width_m, 0, g.middle.width_m * slice_m};
    for (const double mm : kStripLengths_mm) {
      if (mm < least_mm) continue;  // fewer than six of the largest grains
      length.boxes.push_back(
          pressing(scale, {mm * 1e-3, slice_m, kStripDepth_mm * 1e-3}, true, strip));
    }
    Series depth = length;
    depth.varied = "depth";
    depth.boxes.clear();
    for (const double mm : kStripDepths_mm) {
      if (mm < least_mm * 4 / 6) continue;
      depth.boxes.push_back(
          pressing(scale, {kStripLength_mm * 1e-3, slice_m, mm * 1e-3}, true, strip));
    }
    series_.push_back(std::move(length));
    series_.push_back(std::move(depth));
  }

  /// In walls, as the experiments.
  void add_foot(double scale) {
    const sim::Foot& foot = bench_.settings().foot;
    const Eigen::Vector2d print = foot_plan_m(foot, 0).sizes();
    const Indenter plain = make_foot(foot, 0, false);
    const auto box = [&](double factor, double depth_mm) {
      // Whole centimetres.
      return Box{std::round(factor * print.x() * 100) / 100,
                 std::round(factor * print.y() * 100) / 100, depth_mm * 1e-3};
    };
    const double least_m = 6 * scale * bench_.settings().bed.largest_diameter_m();
    Series size{"foot", "length and width", {}, print.x(), print.y(), print.x() * print.y()};
    for (const double factor : kFootFactors) {
      if (box(factor, kFootDepth_mm).width_m < least_m) continue;
      size.boxes.push_back(pressing(scale, box(factor, kFootDepth_mm), false, plain));
    }
    Series depth = size;
    depth.varied = "depth";
    depth.boxes.clear();
    for (const double mm : kFootDepths_mm) {
      if (mm * 1e-3 < least_m * 4 / 6) continue;
      depth.boxes.push_back(pressing(scale, box(kFootFactor, mm), false, plain));
    }
    series_.push_back(std::move(size));
    series_.push_back(std::move(depth));
  }

  Sample force(std::size_t first, double depth_m) const {
    std::vector<double> values;
    for (int i = 0; i < bed_count_; ++i) {
      values.push_back(curves_[first + std::size_t(i)].force_at_N(depth_m));
    }
    return sample_of(values);
  }

  void report() {
    Table table({{"body_name"},
                 {"varied_name"},
                 {"box_mm_name"},
                 {"length_over_body_ratio", 2},
                 {"width_over_body_ratio", 2},
                 {"depth_over_body_width_ratio", 2},
                 {"grain_count"},
                 {"solid_share_ratio", 3},
                 {"bed_count"},
                 {"depth_mm", 0},
                 {"force_N", 1},
                 {"over_largest_ratio", 3},
                 {"standard_error_ratio", 3}});
    std::vector<PlotLine> lines;
    std::size_t first = 0;
    for (const Series& s : series_) {
      const std::size_t last = first + (s.boxes.size() - 1) * std::size_t(bed_count_);
      for (const PressCase& c : s.boxes) {
        for (const double depth_m : kDepths_m) {
          table.row(row(s, c, first, last, depth_m));
        }
        const auto begin = curves_.begin() + std::ptrdiff_t(first);
        lines.push_back(mean_line(
            s.body + " " + Box{c.bed.box_length_m, c.bed.box_width_m, c.bed.depth_m}.text(),
            {begin, begin + bed_count_}, s.area_m2, int(&c - s.boxes.data()), s.varied == "depth"));
        first += std::size_t(bed_count_);
      }
    }
    bench_.finish(notes(), table, "Force over footprint; dashed: depth of the box varied", "kPa",
                  lines);
  }

  std::vector<Table::Cell> row(const Series& s, const PressCase& c, std::size_t first,
                               std::size_t last, double depth_m) const {
    const Sample here = force(first, depth_m), largest = force(last, depth_m);
    const double ratio = here.mean / largest.mean;
    // Other beds, so the two errors add.
    const double error = first == last ? 0
                                       : ratio * std::hypot(here.standard_error / here.mean,
                                                            largest.standard_error / largest.mean);
    const bool is_strip = s.foot_y_m == 0;
    return {s.body,
            s.varied,
            Box{c.bed.box_length_m, c.bed.box_width_m, c.bed.depth_m}.text(),
            c.bed.box_length_m / s.foot_x_m,
            is_strip ? std::nan("") : c.bed.box_width_m / s.foot_y_m,
            c.bed.depth_m / (is_strip ? s.foot_x_m : s.foot_y_m),
            std::int64_t(curves_[first].grain_count),
            curves_[first].solid_share,
            std::int64_t(here.n),
            depth_m * 1e3,
            here.mean,
            ratio,
            error};
  }

  std::string notes() const {
    char text[400];
    std::snprintf(
        text, sizeof text,
        "Pressed at %g m/s, beds of seeds %lld to %lld. over largest: mean force over that\n"
        "in the last box of the series. Strips in periodic boxes, the foot in walls.\n",
        bench_.settings().sinkage.speed_m_s, static_cast<long long>(bench_.options().seed),
        static_cast<long long>(bench_.options().seed + bed_count_ - 1));
    return text;
  }

  StudyBench bench_;
  std::vector<std::string> bodies_;
  int bed_count_;
  std::vector<Series> series_;
  std::vector<PressCurve> curves_;
};

}  // namespace

void run_box_study(const StudyOptions& options) {
  BoxStudy(options).go();
}

}  // namespace hoof::tools
