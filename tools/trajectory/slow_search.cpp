#include "tools/trajectory/slow_search.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools::trajectory {
namespace {

class Scan {
 public:
  Scan(const AxisProblem& axis, double end_s, const SlowSearch& search)
      : axis_(axis), end_s_(end_s), search_(search) {
    ramp_s_ = std::fabs(axis.target_acceleration - axis.acceleration) / axis.limits.max_jerk;
  }

  std::vector<Durations> run() {
    if (ramp_s_ > end_s_ * (1 + 1e-9)) return {};
    sample();
    add_velocity_borders();
    if (!search_.velocity_only) add_position_peaks();
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.t < b.t; });
    return intervals();
  }

 private:
  struct Point {
    double t;
    double velocity;  // margin, with the slack, in units of the size of the velocities
    double position;
    bool feasible() const { return velocity >= 0 && position >= 0; }
  };

  Point at(double t) const {
    // Relative to the velocities and the way there may be, not to the ends wanted alone.
    const EndSlack unit = relative_slack(axis_, t, 1);
    const SlowMargins m = slow_margins(axis_, t);
    const double floor = 1e-300;
    Point point{t, m.velocity / (unit.velocity + floor) + search_.slack,
                m.position / (unit.position + floor) + 4 * search_.slack};
    if (search_.velocity_only) point.position = 1;
    if (m.ramp < -1e-12 * t) point.velocity = -1;
    return point;
  }

  // Evenly, and denser towards the shortest.
  void sample() {
    const int n = search_.samples;
    points_.push_back(at(ramp_s_));
    for (int k = 1; k <= n; ++k) {
      const double x = static_cast<double>(k) / n;
      points_.push_back(at(ramp_s_ + (end_s_ - ramp_s_) * x * (0.25 + 0.75 * x)));
    }
  }

  // Between neighbours that differ, by halving: the border, as seen from the feasible side.
  template <typename Feasible>
  Point border(Point from, Point to, const Feasible& feasible) const {
    const bool first = feasible(from);
    for (int i = 0; i < 60 && to.t - from.t > 1e-13 * to.t; ++i) {
      const Point middle = at(from.t + (to.t - from.t) / 2);
      (feasible(middle) == first ? from : to) = middle;
    }
    return first ? from : to;
  }

  // At the ends of what the velocities allow the motion is unique, and may be a lone solution.
  void add_velocity_borders() {
    const auto feasible = [](const Point& p) { return p.velocity >= 0; };
    add_peaks([](const Point& p) { return p.velocity; });
    const auto exactly = [&](const Point& p) { return p.velocity >= search_.slack; };
    std::vector<Point> found;
    for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
      const Point& a = points_[k];
      const Point& b = points_[k + 1];
      if (feasible(a) != feasible(b)) found.push_back(border(a, b, feasible));
      if (exactly(a) != exactly(b)) found.push_back(border(a, b, exactly));
    }
    add(found);
  }

  void add_position_peaks() {
    add_peaks([](const Point& p) { return p.velocity >= 0 ? p.position : -1; });
  }

  // Local maxima below zero: an interval may hide between the samples.
  template <typename Height>
  void add_peaks(const Height& height) {
    std::vector<Point> found;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      const double h = height(points_[k]);
      if (h >= 0 || h <= -1) continue;
      const bool over_left = k == 0 || height(points_[k - 1]) <= h;
      const bool over_right = k + 1 == points_.size() || height(points_[k + 1]) <= h;
      if (!over_left || !over_right) continue;
      const double left = points_[k == 0 ? 0 : k - 1].t;
      const double right = points_[std::min(k + 1, points_.size() - 1)].t;
      found.push_back(peak(left, right, height));
    }
    add(found);
  }

  // Golden section.
  template <typename Height>
  Point peak(double left, double right, const Height& height) const {
    constexpr double kGolden = 0.6180339887498949;
    Point a = at(right - kGolden * (right - left));
    Point b = at(left + kGolden * (right - left));
    for (int i = 0; i < 60 && right - left > 1e-12 * right; ++i) {
      if (height(a) >= height(b)) {
        right = b.t;
        b = a;
        a = at(right - kGolden * (right - left));
      } else {
        left = a.t;
        a = b;
        b = at(left + kGolden * (right - left));
      }
      if (height(a) >= 0 || height(b) >= 0) break;
    }
    return height(a) >= height(b) ? a : b;
  }

  void add(const std::vector<Point>& found) {
    points_.insert(points_.end(), found.begin(), found.end());
    std::sort(points_.begin(), points_.end(),
              [](const Point& a, const Point& b) { return a.t < b.t; });
  }

  std::vector<Durations> intervals() const {
    const auto feasible = [](const Point& p) { return p.feasible(); };
    std::vector<Durations> all;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (!points_[k].feasible()) continue;
      const std::size_t first = k;
      while (k + 1 < points_.size() && points_[k + 1].feasible()) ++k;
      Durations durations{points_[first].t, points_[k].t};
      if (first > 0) durations.from_s = border(points_[first - 1], points_[first], feasible).t;
      if (k + 1 < points_.size()) durations.to_s = border(points_[k], points_[k + 1], feasible).t;
      all.push_back(durations);
    }
    return all;
  }

  AxisProblem axis_;
  double end_s_;
  SlowSearch search_;
  double ramp_s_;
  std::vector<Point> points_;
};

// The first duration >= t in one axis's set, or none.
std::optional<double> next_in(const std::vector<Durations>& set, double t) {
  constexpr double kBorder = 1e-9;  // how well the borders are known
  for (const Durations& d : set) {
    if (t <= d.to_s * (1 + kBorder)) return std::max(t, d.from_s);
  }
  return std::nullopt;
}

}  // namespace

std::vector<Durations> slow_durations(const AxisProblem& axis, double end_s,
                                      const SlowSearch& search) {
  return Scan(axis, end_s, search).run();
}

std::optional<double> first_common(const std::vector<std::vector<Durations>>& axes, double from_s,
                                   double step_s) {
  const auto stepped = [&](double t) {
    return step_s > 0 ? std::ceil(t / step_s * (1 - 1e-9)) * step_s : t;
  };
  double t = stepped(from_s);
  for (std::size_t agreed = 0, i = 0; agreed < axes.size(); i = (i + 1) % axes.size()) {
    const std::optional<double> next = next_in(axes[i], t);
    if (!next) return std::nullopt;
    agreed = *next > t * (1 + 1e-9) ? 0 : agreed + 1;
    if (*next > t) t = stepped(*next);
  }
  return t;
}

}  // namespace hoof::tools::trajectory
