// Checks a built profile by integrating its pieces in extended precision: where they lead, and how
// far they leave the limits. Shares no formula with the solver.
#pragma once

#include <algorithm>
#include <cmath>

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

  void merge(const Audit& other) {
    end_error = std::max(end_error, other.end_error);
    overshoot = std::max(overshoot, other.overshoot);
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
    miss(elapsed_s - profile.duration_s(), std::max<long double>(1, elapsed_s));
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
    if (jerk_limited_) beyond(std::fabs(j), limits_.max_jerk);
    if (!after_brake) return to;
    armed_ = armed_ || without_brake || velocity_inside(from.v);
    check_state(from.v, from.a);
    const long double t_flat = j != 0 ? -from.a / j : 0;
    if (t_flat > 0 && t_flat < t) check_state(from.v + t_flat * from.a / 2, 0);
    check_state(to.v, to.a);
    return to;
  }

  void compare(const Motion& end, long double p, long double v, long double a) {
    miss(end.p - p, reach_);
    miss(end.v - v, speed_);
    if (jerk_limited_) miss(end.a - a, push_);  // otherwise it jumps by design
  }

  void miss(long double difference, long double scale) {
    audit_.end_error =
        std::max(audit_.end_error, static_cast<double>(std::fabs(difference) / scale));
  }

  void beyond(long double value, long double bound) {
    const long double scale = std::max<long double>(1, std::fabs(bound));
    audit_.overshoot = std::max(audit_.overshoot, static_cast<double>((value - bound) / scale));
  }

  bool velocity_inside(long double v) const {
    return v <= limits_.max_velocity && v >= limits_.min_velocity;
  }

  void check_state(long double v, long double a) {
    if (velocity_limited_ && armed_) {
      beyond(v, limits_.max_velocity);
      beyond(-v, -static_cast<long double>(limits_.min_velocity));
    }
    beyond(a, limits_.max_acceleration);
    beyond(-a, -static_cast<long double>(limits_.min_acceleration));
  }

  Limits limits_;
  bool velocity_limited_;
  bool jerk_limited_;
  bool armed_ = false;
  long double reach_ = 1, speed_ = 1, push_ = 1;
  Audit audit_;
};

}  // namespace hoof::tools::trajectory
