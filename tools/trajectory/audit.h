// Checks a built profile by integrating its pieces in extended precision: where they lead, and how
// far they leave the limits. Shares no formula with the solver.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/input.h"
#include "firmware/trajectory/profile.h"

namespace hoof::tools::trajectory {

struct Audit {
  // Largest miss of a piece against the state the next one starts from, and of the last piece
  // against the target; in position, velocity or acceleration, relative to the largest magnitude on
  // the way where that is above 1; and of the pieces' time against the duration, likewise.
  double end_error = 0;
  // Beyond velocity, acceleration or jerk limits, relative where the limit is above 1. The
  // acceleration counts from the end of the brake on, the velocity from when it is inside after it.
  double overshoot = 0;
  // The parts of both that the number format does not explain: a few of its roundings of the
  // largest speed (times the duration, for positions), acceleration and jerk on the way. They
  // matter in float where one limit is a ten-thousandth of another, and to motions of days.
  double unexplained_end_error = 0;
  double unexplained_overshoot = 0;

  void merge(const Audit& other) {
    end_error = std::max(end_error, other.end_error);
    overshoot = std::max(overshoot, other.overshoot);
    unexplained_end_error = std::max(unexplained_end_error, other.unexplained_end_error);
    unexplained_overshoot = std::max(unexplained_overshoot, other.unexplained_overshoot);
  }
};

template <typename Real>
class Auditor {
 public:
  using Limits = firmware::trajectory::AxisLimits<Real>;
  using Profile = firmware::trajectory::Profile<Real>;
  using Interface = firmware::trajectory::Interface;

  Auditor(const Limits& limits, Interface interface)
      : limits_(limits),
        velocity_limited_(interface == Interface::kPosition),
        jerk_limited_(std::isfinite(static_cast<double>(limits.max_jerk))) {}

  // `displacement` and the end values: what the profile is to reach, relative to its start.
  Audit run(const Profile& profile, double displacement, double end_velocity,
            double end_acceleration) {
    audit_ = {};
    armed_ = false;
    find_scales(profile, displacement);
    long double elapsed_s = 0;
    for (int i = 0; i < profile.pieces(); ++i) {
      const auto& piece = profile.piece(i);
      elapsed_s += piece.duration_s;
      const Motion end = follow(piece, piece.begin_s >= profile.brake_s(), profile.brake_s() == 0);
      if (i + 1 < profile.pieces()) {
        const auto& next = profile.piece(i + 1).state;
        compare(end, next.position, next.velocity, next.acceleration);
      } else {
        compare(end, displacement, end_velocity, end_acceleration);
      }
    }
    const long double time_scale = std::max<long double>(1, elapsed_s);
    miss(elapsed_s - profile.duration_s(), time_scale, kRoundings * time_scale);
    return audit_;
  }

 private:
  struct Motion {
    long double p, v, a;
  };

  void find_scales(const Profile& profile, double displacement) {
    // The target counts too: a cruise's last state lies at its start.
    reach_ = std::max<long double>(1, std::fabs(displacement));
    speed_ = push_ = 1;
    const auto largest = [](Real a, Real b) -> long double {
      return std::max(std::fabs(a), std::fabs(b));
    };
    // Two extremes are mixed, so rounding is that of the limits, whatever the mix comes to; and
    // times are rounded to the size of the whole duration.
    const long double t = profile.duration_s();
    const long double v = largest(limits_.max_velocity, limits_.min_velocity);
    const long double a = largest(limits_.max_acceleration, limits_.min_acceleration);
    speed_rounding_ = kRoundings * (v + t * a);
    position_rounding_ = kRoundings * (reach_ + t * (v + t * a));
    for (int i = 0; i < profile.pieces(); ++i) {
      const auto& state = profile.piece(i).state;
      reach_ = std::max<long double>(reach_, std::fabs(state.position));
      speed_ = std::max<long double>(speed_, std::fabs(state.velocity));
      push_ = std::max<long double>(push_, std::fabs(state.acceleration));
    }
  }

  // To the end of the piece, checking its limits on the way.
  Motion follow(const typename Profile::Piece& piece, bool after_brake, bool without_brake) {
    const long double t = piece.duration_s;
    const long double j = piece.jerk;
    const Motion from{piece.state.position, piece.state.velocity, piece.state.acceleration};
    const Motion to{from.p + t * (from.v + t * (from.a / 2 + t * j / 6)),
                    from.v + t * (from.a + t * j / 2), from.a + t * j};
    if (jerk_limited_) beyond(std::fabs(j), limits_.max_jerk, 0);
    if (!after_brake) return to;
    armed_ = armed_ || without_brake || velocity_inside(from.v);
    check_state(from.v, from.a);
    const long double t_flat = j != 0 ? -from.a / j : 0;
    if (t_flat > 0 && t_flat < t) check_state(from.v + t_flat * from.a / 2, 0);
    check_state(to.v, to.a);
    return to;
  }

  void compare(const Motion& end, long double p, long double v, long double a) {
    miss(end.p - p, reach_, position_rounding_);
    miss(end.v - v, speed_, speed_rounding_);
    if (jerk_limited_) miss(end.a - a, push_, kRoundings * push_);  // otherwise it jumps by design
  }

  static void raise(double& worst, long double value) {
    worst = std::max(worst, static_cast<double>(value));
  }

  void miss(long double difference, long double scale, long double rounding) {
    const long double error = std::fabs(difference);
    raise(audit_.end_error, error / scale);
    raise(audit_.unexplained_end_error, (error - rounding) / scale);
  }

  void beyond(long double value, long double bound, long double rounding) {
    const long double scale = std::max<long double>(1, std::fabs(bound));
    raise(audit_.overshoot, (value - bound) / scale);
    raise(audit_.unexplained_overshoot, (value - bound - rounding) / scale);
  }

  bool velocity_inside(long double v) const {
    return v <= limits_.max_velocity && v >= limits_.min_velocity;
  }

  void check_state(long double v, long double a) {
    if (velocity_limited_ && armed_) {
      beyond(v, limits_.max_velocity, kRoundings * speed_);
      beyond(-v, -static_cast<long double>(limits_.min_velocity), kRoundings * speed_);
    }
    beyond(a, limits_.max_acceleration, kRoundings * push_);
    beyond(-a, -static_cast<long double>(limits_.min_acceleration), kRoundings * push_);
  }

  Limits limits_;
  bool velocity_limited_;
  bool jerk_limited_;
  bool armed_ = false;
  static constexpr long double kRoundings = 8 * std::numeric_limits<Real>::epsilon();
  long double reach_ = 1, speed_ = 1, push_ = 1;
  long double speed_rounding_ = 0, position_rounding_ = 0;
  Audit audit_;
};

}  // namespace hoof::tools::trajectory
