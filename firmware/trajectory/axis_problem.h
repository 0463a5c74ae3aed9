// What one axis has to do, in the caller's units.
#pragma once

namespace hoof::firmware::trajectory {

template <typename Real>
struct AxisLimits {
  Real max_velocity, min_velocity;
  Real max_acceleration, min_acceleration;
  Real max_jerk;
};

template <typename Real>
struct AxisProblem {
  Real displacement;  // target position - start position, subtracted before anything else
  Real velocity, acceleration;
  Real target_velocity, target_acceleration;
  AxisLimits<Real> limits;
};

// No feasible duration.
template <typename Real>
inline constexpr Real kNever = Real(-1);

}  // namespace hoof::firmware::trajectory
