#include "tools/trajectory/slow_check.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hoof::tools::trajectory {
namespace {

using Wide = long double;

struct Line {
  Wide offset;
  Wide slope;
  Wide at(Wide t) const { return offset + slope * t; }
};

struct Travel {
  Wide velocity_gain = 0;
  Wide displacement = 0;
  Wide highest_velocity = 0;
};

// The x in [below, above] with function(x) = 0, function rising from negative to positive: false
// position with the Illinois rule, down to the resolution of x.
template <typename Function>
Wide rising_root(const Function& function, Wide below, Wide above) {
  Wide f_below = function(below);
  Wide f_above = function(above);
  if (!(f_below < 0)) return below;
  if (!(f_above > 0)) return above;
  int side = 0;
  Wide last_width = above - below;
  for (int i = 0; i < 300; ++i) {
    const Wide width = above - below;
    // False position that does not halve the bracket in three steps gives way to halving.
    const bool slow = i % 3 == 2 && width > last_width / 2;
    if (i % 3 == 2) last_width = width;
    Wide x = slow ? below + width / 2 : below - f_below * width / (f_above - f_below);
    if (!(x > below && x < above)) x = below + width / 2;
    if (!(x > below && x < above)) break;
    const Wide f = function(x);
    if (f == 0) return x;
    if (f < 0) {
      below = x;
      f_below = f;
      if (side < 0) f_above /= 2;
      side = -1;
    } else {
      above = x;
      f_above = f;
      if (side > 0) f_below /= 2;
      side = 1;
    }
  }
  return above;
}

class SlowAxis {
 public:
  explicit SlowAxis(const AxisProblem& axis, bool mirrored)
      : sign_(mirrored ? -1 : 1),
        v0_(sign_ * axis.velocity),
        a0_(sign_ * axis.acceleration),
        vf_(sign_ * axis.target_velocity),
        af_(sign_ * axis.target_acceleration),
        v_max_(mirrored ? -axis.limits.min_velocity : axis.limits.max_velocity),
        a_max_(mirrored ? -axis.limits.min_acceleration : axis.limits.max_acceleration),
        a_min_(mirrored ? -axis.limits.max_acceleration : axis.limits.min_acceleration),
        jerk_(axis.limits.max_jerk) {}

  // With r beyond every envelope the motion is the envelope itself.
  Wide largest_gain(Wide t) const { return travel(t, far(t), v0_, a0_, af_).velocity_gain; }
  Wide smallest_gain(Wide t) const { return travel(t, -far(t), v0_, a0_, af_).velocity_gain; }

  Wide largest_displacement(Wide t) const {
    const auto excess = [&](Wide r) {
      return travel(t, r, v0_, a0_, af_).velocity_gain - (vf_ - v0_);
    };
    const Travel free = travel(t, rising_root(excess, -far(t), far(t)), v0_, a0_, af_);
    const Wide highest_end = std::max(v0_, vf_);
    if (free.highest_velocity <= std::max(v_max_, highest_end)) return free.displacement;
    const Part up = fastest_to_cruise(v0_, a0_, false);
    const Part down = fastest_to_cruise(vf_, -af_, true);
    const Wide cruise = t - up.duration - down.duration;
    // Without the time to get there and away the velocity passes v_max by rounding only.
    if (cruise < 0) return free.displacement;
    return up.displacement + down.displacement + v_max_ * cruise;
  }

 private:
  struct Part {
    Wide duration;
    Wide displacement;
  };

  Wide far(Wide t) const { return 2 * (a_max_ - a_min_ + jerk_ * t) + std::fabs(a0_); }

  // Shortest way from (v, a) to (v_max, 0). Backwards in time the acceleration limits swap.
  Part fastest_to_cruise(Wide v, Wide a, bool backwards) const {
    SlowAxis axis = *this;
    if (backwards) {
      axis.a_max_ = -a_min_;
      axis.a_min_ = -a_max_;
    }
    Wide below = std::fabs(a) / jerk_;
    Wide above = below + 1;
    const auto gain = [&](Wide t) { return axis.travel(t, axis.far(t), v, a, 0); };
    while (gain(above).velocity_gain < v_max_ - v) above *= 2;
    above = rising_root([&](Wide t) { return gain(t).velocity_gain - (v_max_ - v); }, below, above);
    return {above, gain(above).displacement};
  }

  Travel travel(Wide t_end, Wide r, Wide v, Wide a0, Wide af) const {
    const std::array<Line, 7> lines = {{{a0, jerk_},
                                        {a_max_, 0},
                                        {af + jerk_ * t_end, -jerk_},
                                        {a0, -jerk_},
                                        {a_min_, 0},
                                        {af - jerk_ * t_end, jerk_},
                                        {r, -jerk_}}};
    const auto acceleration = [&](Wide t) {
      const Wide high = std::min({lines[0].at(t), lines[1].at(t), lines[2].at(t)});
      const Wide low = std::max({lines[3].at(t), lines[4].at(t), lines[5].at(t)});
      return std::max(low, std::min(high, lines[6].at(t)));
    };
    std::array<Wide, 23> borders;
    std::size_t count = 0;
    borders[count++] = 0;
    borders[count++] = t_end;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t j = i + 1; j < lines.size(); ++j) {
        if (lines[i].slope == lines[j].slope) continue;
        const Wide t = (lines[j].offset - lines[i].offset) / (lines[i].slope - lines[j].slope);
        if (t > 0 && t < t_end) borders[count++] = t;
      }
    }
    std::sort(borders.begin(), borders.begin() + static_cast<std::ptrdiff_t>(count));
    Travel result;
    const Wide v_start = v;
    result.highest_velocity = v;
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const Wide dt = borders[i + 1] - borders[i];
      if (!(dt > 0)) continue;
      const Wide a = acceleration(borders[i]);
      const Wide b = acceleration(borders[i + 1]);
      if (a > 0 && b < 0) {
        result.highest_velocity = std::max(result.highest_velocity, v + a * a / (a - b) * dt / 2);
      }
      result.displacement += dt * (v + dt * (2 * a + b) / 6);
      v += dt * (a + b) / 2;
      result.highest_velocity = std::max(result.highest_velocity, v);
    }
    result.velocity_gain = v - v_start;
    return result;
  }

  Wide sign_, v0_, a0_, vf_, af_, v_max_, a_max_, a_min_, jerk_;
};

}  // namespace

EndSlack relative_slack(const AxisProblem& axis, double duration_s, double relative) {
  const double a_max = std::max(axis.limits.max_acceleration, -axis.limits.min_acceleration);
  const double speed = std::fabs(axis.velocity) + std::fabs(axis.target_velocity);
  const double velocity = relative * (speed + duration_s * a_max);
  return {velocity, velocity * duration_s};
}

SlowMargins slow_margins(const AxisProblem& axis, double duration_s) {
  const Wide t = duration_s;
  const SlowAxis upper(axis, false);
  const SlowAxis lower(axis, true);
  const Wide gain = axis.target_velocity - axis.velocity;
  SlowMargins margins;
  margins.ramp = static_cast<double>(t - std::fabs(axis.target_acceleration - axis.acceleration) /
                                             axis.limits.max_jerk);
  margins.velocity =
      static_cast<double>(std::min(upper.largest_gain(t) - gain, gain - upper.smallest_gain(t)));
  const Wide displacement = axis.displacement;
  margins.position = static_cast<double>(std::min(upper.largest_displacement(t) - displacement,
                                                  displacement + lower.largest_displacement(t)));
  return margins;
}

bool slowly_feasible(const AxisProblem& axis, double duration_s, const EndSlack& slack) {
  const SlowMargins margins = slow_margins(axis, duration_s);
  return margins.ramp >= -std::fabs(slack.velocity) / axis.limits.max_acceleration &&
         margins.velocity >= -slack.velocity && margins.position >= -slack.position;
}

}  // namespace hoof::tools::trajectory
