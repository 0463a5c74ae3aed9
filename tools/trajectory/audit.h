// Checks a built profile by integrating its pieces in extended precision: where it ends, and how
// far it leaves its limits. Shares no formula with the solver.
#pragma once

#include <algorithm>
#include <cmath>

#include "firmware/trajectory/axis_problem.h"
#include "firmware/trajectory/input.h"
#include "firmware/trajectory/profile.h"

namespace hoof::tools::trajectory {

struct Audit {
  // At the end, against the target; relative to the largest magnitude on the way where that is > 1.
  double position_error = 0;
  double velocity_error = 0;
  double acceleration_error = 0;
  // Beyond velocity, acceleration or jerk limits, relative where the limit is > 1. The acceleration
  // counts from the end of the brake on, the velocity from when it is inside after the brake.
  double overshoot = 0;
  // Jump of the stored state from one piece to the next (the acceleration jumps by design where the
  // jerk is unlimited).
  double discontinuity = 0;

  double end_error() const {
    return std::max({position_error, velocity_error, acceleration_error});
  }

  void merge(const Audit& other) {
    position_error = std::max(position_error, other.position_error);
    velocity_error = std::max(velocity_error, other.velocity_error);
    acceleration_error = std::max(acceleration_error, other.acceleration_error);
    overshoot = std::max(overshoot, other.overshoot);
    discontinuity = std::max(discontinuity, other.discontinuity);
  }
};

template <typename Real>
class Auditor {
 public:
  Auditor(const firmware::trajectory::AxisLimits<Real>& limits,
          firmware::trajectory::Interface interface)
      : limits_(limits),
        velocity_limited_(interface == firmware::trajectory::Interface::kPosition) {}

  // From the profile's own start state to `end`, given relative to the start position.
  Audit run(const firmware::trajectory::Profile<Real>& profile, double displacement,
            double end_velocity, double end_acceleration) {
    audit_ = {};
    const bool jerk_limited = std::isfinite(static_cast<double>(limits_.max_jerk));
    long double p = 0, v = 0, a = 0;
    long double reach = 1, speed = 1, push = 1;
    for (int i = 0; i < profile.pieces(); ++i) {
      const auto& piece = profile.piece(i);
      if (i == 0) {
        v = piece.state.velocity;
        a = piece.state.acceleration;
      }
      if (!jerk_limited) a = piece.state.acceleration;
      jump(piece.state.position - p, reach);
      jump(piece.state.velocity - v, speed);
      jump(piece.state.acceleration - a, push);
      const long double t = piece.duration_s;
      const long double j = piece.jerk;
      const bool inside = piece.begin_s >= profile.brake_s();
      velocity_armed_ = inside && (velocity_armed_ || profile.brake_s() == 0 || velocity_inside(v));
      if (inside) check_state(v, a);
      if (inside && j != 0) {
        const long double t_flat = -a / j;
        if (t_flat > 0 && t_flat < t) check_state(v + t_flat * (a + t_flat * j / 2), 0);
      }
      if (jerk_limited) beyond(std::fabs(j), limits_.max_jerk);
      p += t * (v + t * (a / 2 + t * j / 6));
      v += t * (a + t * j / 2);
      a += t * j;
      if (inside) check_state(v, a);
      reach = std::max(reach, std::fabs(p));
      speed = std::max(speed, std::fabs(v));
      push = std::max(push, std::fabs(a));
    }
    if (profile.pieces() == 0) {
      v = end_velocity;
      a = end_acceleration;
    }
    audit_.position_error = static_cast<double>(std::fabs(p - displacement) / reach);
    audit_.velocity_error = static_cast<double>(std::fabs(v - end_velocity) / speed);
    if (jerk_limited) {
      audit_.acceleration_error = static_cast<double>(std::fabs(a - end_acceleration) / push);
    }
    return audit_;
  }

 private:
  void jump(long double difference, long double scale) {
    audit_.discontinuity =
        std::max(audit_.discontinuity, static_cast<double>(std::fabs(difference) / scale));
  }

  void beyond(long double value, long double bound) {
    const long double scale = std::max<long double>(1, std::fabs(bound));
    audit_.overshoot = std::max(audit_.overshoot, static_cast<double>((value - bound) / scale));
  }

  bool velocity_inside(long double v) const {
    return v <= limits_.max_velocity && v >= limits_.min_velocity;
  }

  void check_state(long double v, long double a) {
    if (velocity_limited_ && velocity_armed_) {
      beyond(v, limits_.max_velocity);
      beyond(-v, -static_cast<long double>(limits_.min_velocity));
    }
    beyond(a, limits_.max_acceleration);
    beyond(-a, -static_cast<long double>(limits_.min_acceleration));
  }

  firmware::trajectory::AxisLimits<Real> limits_;
  bool velocity_limited_;
  bool velocity_armed_ = false;
  Audit audit_;
};

}  // namespace hoof::tools::trajectory
