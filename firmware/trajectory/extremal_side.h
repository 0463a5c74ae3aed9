// The profile of largest displacement for a given duration, and the first duration at which that
// largest displacement reaches a wanted one.
//
// Source: reachable-interval method. With the end velocities and accelerations fixed, the end
// positions reachable in a time T form an interval [p_min(T), p_max(T)]; p_max belongs to the jerk
// signal +J, [hold a_max], -J, [hold a_min], +J, with a cruise at v_max inside the -J ramp when the
// velocity would pass it. p_min is the same for the mirrored axis.
//
// Everything is written in units that make the jerk limit 1:
//   symbol   meaning                                             unit
//   a0, af   start and target acceleration                       a
//   w        J v                                                 a^2
//   q        J^2 (p - p0)                                        a^3
//   theta    J t                                                 a
//   high     a_max                                               a
//   low      -a_min (a magnitude)                                a
//   ap, aq   peak and trough of the acceleration                 a
//   c0       w0 - a0^2/2: velocity where the first ramp has a=0  a^2
//   c2       wf - af^2/2: the same for the last ramp             a^2
//   c1       velocity where the middle ramp has a=0              a^2
//   k        c2 - c0
// On a ramp of jerk s = +-1 the velocity is c + s a^2/2, which gives every formula below:
//   without holds     c1 = c0 + ap^2 = c2 + aq^2, so ap^2 - aq^2 = k
//   displacement      q = c0 (ap-a0) + c1 (ap-aq) + c2 (af-aq) + (af^3-a0^3)/6
//                       + hold_high (c0+c1)/2 + hold_low (c1+c2)/2 + cruise c1
//   its growth        dq/dtheta = h = c1 - ap aq / 2
#pragma once

#include "firmware/trajectory/increment_solver.h"
#include "firmware/trajectory/scalar.h"

namespace hoof::firmware::trajectory {

// One extremal profile, in the units above.
template <typename Real>
struct Shape {
  Real ap = 0;
  Real aq = 0;
  Real hold_high = 0;
  Real hold_low = 0;
  Real cruise = 0;
  bool cruises = false;
  Real c1 = 0;
};

// One axis as this file sees it. The mirrored axis has all signs of a and w changed and high and
// low exchanged.
template <typename Real>
struct SideProblem {
  Real a0, af, w0, wf;
  Real wd;  // wf - w0, formed by the caller from the difference of the velocities
  Real high, low;
  Real w_max;
};

template <typename Real>
class ExtremalSide {
 public:
  ExtremalSide() = default;

  explicit ExtremalSide(const SideProblem<Real>& axis)
      : a0_(axis.a0),
        af_(axis.af),
        high_(axis.high),
        low_(axis.low),
        c0_(axis.w0 - axis.a0 * axis.a0 / 2),
        c2_(axis.wf - axis.af * axis.af / 2),
        k_(axis.wd - (axis.af - axis.a0) * (axis.af + axis.a0) / 2),
        sum_(c0_ + c2_),
        ends_((axis.af - axis.a0) * (axis.af * axis.af + axis.af * axis.a0 + axis.a0 * axis.a0) /
              6),
        e_cruise_(axis.w_max - c0_),
        w_max_(axis.w_max) {}

  // Start of a component of feasible durations at which the velocity gain is the largest possible:
  // ramp to `peak` (holding there for `hold`), ramp to af.
  Shape<Real> largest_gain(Real peak, Real hold) const {
    Shape<Real> shape;
    shape.ap = peak;
    shape.aq = af_;
    shape.hold_high = hold;
    shape.c1 = c2_ + af_ * af_;
    return shape;
  }

  // The same with the smallest possible gain: ramp down to -trough (holding there), ramp up to af.
  Shape<Real> smallest_gain(Real trough, Real hold) const {
    Shape<Real> shape;
    shape.ap = a0_;
    shape.aq = -trough;
    shape.hold_low = hold;
    shape.c1 = c0_ + a0_ * a0_;
    return shape;
  }

  // The profile of largest displacement that takes theta. theta must be feasible for the velocity.
  Shape<Real> at_duration(Real theta) const {
    Shape<Real> shape;
    const Real d = positive_part(theta + a0_ - af_) / 2;  // ap - aq when nothing is held
    if (!(d > 0)) {
      return largest_gain(maximum(a0_, af_), 0);
    }
    const Real s = k_ / d;
    shape.ap = (s + d) / 2;
    shape.aq = (s - d) / 2;
    if (shape.ap > high_) {
      hold_high_only(d, shape);
      if (shape.aq < -low_) hold_both(d, shape);
    } else if (shape.aq < -low_) {
      hold_low_only(d, shape);
      if (shape.ap > high_) hold_both(d, shape);
    }
    shape.ap = maximum(shape.ap, minimum(a0_, high_));
    shape.aq = minimum(shape.aq, maximum(af_, -low_));
    shape.c1 = c0_ + shape.ap * shape.ap + high_ * shape.hold_high;
    if (shape.ap > 0 && shape.aq < 0 && shape.c1 > w_max_) {
      shape = at_cruise_velocity();
      shape.cruises = true;
      shape.cruise = positive_part(theta - duration(shape));
    }
    return shape;
  }

  Real duration(const Shape<Real>& shape) const {
    return (shape.ap - a0_) + (shape.ap - shape.aq) + (af_ - shape.aq) + shape.hold_high +
           shape.hold_low + shape.cruise;
  }

  Real displacement(const Shape<Real>& shape) const {
    return c0_ * (shape.ap - a0_) + shape.c1 * (shape.ap - shape.aq + shape.cruise) +
           c2_ * (af_ - shape.aq) + ends_ + shape.hold_high * (c0_ + shape.c1) / 2 +
           shape.hold_low * (shape.c1 + c2_) / 2;
  }

  // How far rounding may move displacement(shape).
  Real displacement_rounding(const Shape<Real>& shape) const {
    const Real c1 = magnitude(shape.c1);
    const Real sum = magnitude(c0_) * (shape.ap - a0_) + c1 * (shape.ap - shape.aq + shape.cruise) +
                     magnitude(c2_) * (af_ - shape.aq) + magnitude(ends_) +
                     shape.hold_high * (magnitude(c0_) + c1) / 2 +
                     shape.hold_low * (c1 + magnitude(c2_)) / 2;
    return kRounding<Real> * magnitude(sum);
  }

  // Lengthens `shape` to the first longer profile with displacement `wanted`, which is above that
  // of `shape`. `ends_in_gap`: the feasible durations end before the middle ramp crosses zero.
  // False when there is none.
  bool extend_to(Real wanted, bool ends_in_gap, Shape<Real>& shape) const {
    if (shape.cruises) return extend_cruise(wanted, shape);
    if (k_ > 0 && shape.aq > 0) {
      const EarlyBranch branch{true, c2_, k_, high_, ends_in_gap ? root(a0_ * a0_ - k_) : Real(0)};
      if (extend_early(branch, shape.aq, wanted, shape)) return true;
    } else if (k_ < 0 && shape.ap < 0) {
      const EarlyBranch branch{false, c0_, -k_, low_, ends_in_gap ? root(af_ * af_ + k_) : Real(0)};
      if (extend_early(branch, -shape.ap, wanted, shape)) return true;
    }
    if (ends_in_gap) return false;
    const bool plateau = shape.ap >= 0 && shape.aq <= 0;
    const Real e = first_plateau();
    return extend_plateau(wanted, plateau ? maximum(shape.c1 - c0_, e) : e, shape);
  }

  Real a0() const { return a0_; }
  Real af() const { return af_; }

 private:
  // Before the plateau both ap and aq have one sign; `y` is the smaller of the two magnitudes and
  // falls as the duration grows. Near end: target (aq = y > 0) or start (ap = -y < 0).
  struct EarlyBranch {
    bool at_target;  // aq = y; otherwise ap = -y
    Real c_near;     // c2 or c0
    Real k;          // the other magnitude is sqrt(k + y^2), limited to `limit`
    Real limit;
    Real y_end;
  };

  void hold_high_only(Real d, Shape<Real>& shape) const {
    shape.ap = high_;
    shape.aq = high_ - root(2 * high_ * d - k_);
    shape.hold_low = 0;
    shape.hold_high = positive_part((k_ + (shape.aq - high_) * (shape.aq + high_)) / high_);
  }

  void hold_low_only(Real d, Shape<Real>& shape) const {
    shape.aq = -low_;
    shape.ap = -low_ + root(2 * low_ * d + k_);
    shape.hold_high = 0;
    shape.hold_low = positive_part(((shape.ap - low_) * (shape.ap + low_) - k_) / low_);
  }

  void hold_both(Real d, Shape<Real>& shape) const {
    const Real held = 2 * (d - high_ - low_);
    const Real gain = k_ + (low_ - high_) * (low_ + high_);
    const Real hold_high = (gain + low_ * held) / (high_ + low_);
    const Real hold_low = (high_ * held - gain) / (high_ + low_);
    if (hold_high < 0) return hold_low_only(d, shape);
    if (hold_low < 0) return hold_high_only(d, shape);
    shape.ap = high_;
    shape.aq = -low_;
    shape.hold_high = hold_high;
    shape.hold_low = hold_low;
  }

  // Profiles with a plateau (ap >= 0 >= aq), by the velocity c1 = c0 + e of their plateau.
  Shape<Real> at_peak_velocity(Real e) const { return plateau(e, e - k_, c0_ + e); }

  // The one whose plateau is at v_max; of its own, for after a fast start c0 + e rounds badly.
  Shape<Real> at_cruise_velocity() const { return plateau(e_cruise_, w_max_ - c2_, w_max_); }

  // rise = c1 - c0, fall = c1 - c2
  Shape<Real> plateau(Real rise, Real fall, Real c1) const {
    Shape<Real> shape;
    shape.c1 = c1;
    if (rise > high_ * high_) {
      shape.ap = high_;
      shape.hold_high = (rise - high_ * high_) / high_;
    } else {
      shape.ap = maximum(root(rise), a0_);
    }
    if (fall > low_ * low_) {
      shape.aq = -low_;
      shape.hold_low = (fall - low_ * low_) / low_;
    } else {
      shape.aq = minimum(-root(fall), af_);
    }
    return shape;
  }

  // The lowest plateau: ap >= max(a0, 0) and aq <= min(af, 0).
  Real first_plateau() const {
    const Real a0 = positive_part(a0_);
    const Real af = positive_part(-af_);
    return maximum(a0 * a0, k_ + af * af);
  }

  // Growth of the displacement while `limit` is held and the other extreme, y, falls by s:
  // dq = h dtheta with h = c_near + y^2 - y limit / 2 and dtheta = -2 (1 - y / limit) dy.
  Real solve_held(Real c_near, Real limit, Real y, Real wanted_growth, Real s_max) const {
    const Real inverse = 1 / limit;
    const Real rate = 1 - y * inverse;
    const Real h0 = c_near + y * (y - limit / 2);
    const Real h1 = limit / 2 - 2 * y;
    const Real b1 = 2 * rate * h0;
    const Real b2 = rate * h1 + h0 * inverse;
    const Real b3 = (rate + h1 * inverse) * Real(2.0 / 3.0);
    const Real b4 = inverse / 2;
    const auto growth = [=](Real s) {
      return ValueAndSlope<Real>{s * (b1 + s * (b2 + s * (b3 + s * b4))),
                                 b1 + s * (2 * b2 + s * (3 * b3 + s * 4 * b4))};
    };
    return solve_increment(growth, wanted_growth, s_max);
  }

  // Growth without holds, as d = ap - aq rises by s: dq/dd = c0 + c2 + 3 d^2/4 + k^2/(4 d^2).
  Real solve_free(Real d, Real wanted_growth, Real s_max) const {
    const Real half_sum = d > 0 ? k_ / d / 2 : Real(0);  // (ap + aq) / 2
    const Real half_k = k_ / 2;
    const Real constant = sum_ + Real(0.75) * d * d;
    const auto growth = [=, this](Real s) {
      const Real inverse = 1 / (d + s);
      const Real far = half_k * inverse;
      return ValueAndSlope<Real>{s * (constant + Real(0.75) * d * s + s * s / 4 + half_sum * far),
                                 sum_ + Real(0.75) * (d + s) * (d + s) + far * far};
    };
    return solve_increment(growth, wanted_growth, s_max);
  }

  bool extend_cruise(Real wanted, Shape<Real>& shape) const {
    if (!(w_max_ > 0)) return false;
    shape.cruises = true;
    shape.cruise += positive_part(wanted - displacement(shape)) / w_max_;
    return true;
  }

  Shape<Real> early_shape(const EarlyBranch& branch, Real y) const {
    Shape<Real> shape;
    const Real square = branch.k + y * y;
    Real far = root(square);
    Real hold = 0;
    if (far > branch.limit) {
      far = branch.limit;
      hold = (square - far * far) / far;
    }
    shape.ap = branch.at_target ? far : -y;
    shape.aq = branch.at_target ? y : -far;
    (branch.at_target ? shape.hold_high : shape.hold_low) = hold;
    shape.c1 = branch.c_near + y * y;
    return shape;
  }

  // Before the plateau the displacement may rise, fall and rise again as the duration grows:
  // dq/dtheta is a convex function of y (held) or of d^2 (free), so each part has at most one
  // maximum inside.
  bool extend_early(const EarlyBranch& branch, Real y, Real wanted, Shape<Real>& shape) const {
    const Real border_square = branch.limit * branch.limit - branch.k;
    const Real border = maximum(root(border_square), branch.y_end);
    if (y > border) {
      const Real discriminant = branch.limit * branch.limit / 16 - branch.c_near;
      const Real y_peak = branch.limit / 4 + root(discriminant);
      const auto solve = [&](Real y_low) {
        return y -
               solve_held(branch.c_near, branch.limit, y, wanted - displacement(shape), y - y_low);
      };
      if (discriminant > 0 && y_peak > border && y_peak < y &&
          reaches(early_shape(branch, y_peak), wanted)) {
        shape = early_shape(branch, solve(y_peak));
        return true;
      }
      const Shape<Real> end = early_shape(branch, border);
      if (reaches(end, wanted)) {
        shape = early_shape(branch, solve(border));
        return true;
      }
      shape = end;
      y = border;
    }
    if (!(y > branch.y_end)) return false;
    const Real d = shape.ap - shape.aq;
    const Real y_start = y;
    const auto shape_at = [&](Real at_d) {
      // Both k and d may be nothing but rounding, when a single ramp is almost all there is.
      const Real at_y = at_d > 0 ? (branch.k / at_d - at_d) / 2 : y_start;
      return early_shape(branch, minimum(maximum(at_y, branch.y_end), y_start));
    };
    const Real discriminant = 4 * sum_ * sum_ - 3 * k_ * k_;
    const Shape<Real> end = early_shape(branch, branch.y_end);
    const Real d_end = end.ap - end.aq;
    if (sum_ < 0 && discriminant > 0) {
      const Real d_peak = root(k_ * k_ / (root(discriminant) - 2 * sum_));
      if (d_peak > d && d_peak < d_end && reaches(shape_at(d_peak), wanted)) {
        shape = shape_at(d + solve_free(d, wanted - displacement(shape), d_peak - d));
        return true;
      }
    }
    if (reaches(end, wanted)) {
      shape = shape_at(d + solve_free(d, wanted - displacement(shape), d_end - d));
      return true;
    }
    shape = end;
    return false;
  }

  bool reaches(const Shape<Real>& shape, Real wanted) const {
    return displacement(shape) >= wanted - displacement_rounding(shape);
  }

  // With a plateau dq/dtheta = c1 - ap aq / 2 rises with the duration: the displacement is convex
  // and, being below `wanted` at the start, passes it once. The parts end where a limit is met.
  bool extend_plateau(Real wanted, Real e, Shape<Real>& shape) const {
    Shape<Real> end = at_cruise_velocity();
    if (!(displacement(end) > wanted)) {
      shape = end;
      return extend_cruise(wanted, shape);
    }
    Real e_end = e_cruise_;
    shape = at_peak_velocity(e);
    const Real e_high = high_ * high_;
    const Real e_low = k_ + low_ * low_;
    for (const Real border : {minimum(e_high, e_low), maximum(e_high, e_low)}) {
      if (!(border > e && border < e_cruise_)) continue;
      const Shape<Real> part_end = at_peak_velocity(border);
      if (displacement(part_end) >= wanted) {
        e_end = border;
        end = part_end;
        break;
      }
      shape = part_end;
      e = border;
    }
    solve_part(wanted, e, e_end, end, shape);
    return true;
  }

  void solve_part(Real wanted, Real e, Real e_end, const Shape<Real>& end,
                  Shape<Real>& shape) const {
    const Real growth = wanted - displacement(shape);
    if (!(growth > 0)) return;
    const Real middle = e + (e_end - e) / 2;
    const bool high_held = middle > high_ * high_;
    const bool low_held = middle - k_ > low_ * low_;
    if (high_held && low_held) {
      // dq = h dtheta, dh = de, dtheta = de (1/high + 1/low): a quadratic.
      const Real h = shape.c1 + high_ * low_ / 2;
      const Real r = 2 * growth * (high_ * low_) / (high_ + low_);
      const Real sqrt_term = root(h * h + r);
      e += h > 0 ? r / (h + sqrt_term) : sqrt_term - h;
      shape = at_peak_velocity(minimum(e, e_end));
    } else if (high_held) {
      shape.aq -= solve_held(c2_, high_, shape.aq, growth, shape.aq - end.aq);
      shape.hold_high = positive_part((k_ + (shape.aq - high_) * (shape.aq + high_)) / high_);
      shape.c1 = c2_ + shape.aq * shape.aq;
    } else if (low_held) {
      shape.ap += solve_held(c0_, low_, -shape.ap, growth, end.ap - shape.ap);
      shape.hold_low = positive_part(((shape.ap - low_) * (shape.ap + low_) - k_) / low_);
      shape.c1 = c0_ + shape.ap * shape.ap;
    } else {
      Real d = shape.ap - shape.aq;
      d += solve_free(d, growth, end.ap - end.aq - d);
      shape.ap = maximum((k_ / d + d) / 2, shape.ap);
      shape.aq = minimum((k_ / d - d) / 2, shape.aq);
      shape.c1 = c0_ + shape.ap * shape.ap;
    }
  }

  Real a0_ = 0, af_ = 0, high_ = 0, low_ = 0;
  Real c0_ = 0, c2_ = 0, k_ = 0, sum_ = 0, ends_ = 0;
  Real e_cruise_ = 0, w_max_ = 0;
};

}  // namespace hoof::firmware::trajectory
