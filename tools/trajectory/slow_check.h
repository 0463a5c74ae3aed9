// A slow, independent test of whether one axis can take a duration: no closed forms of
// displacement, no case distinctions. Shares nothing with firmware/trajectory but the numbers.
//
// For a duration T the acceleration lies between the envelopes
//   high(t) = min(a0 + J t, a_max, af + J (T - t)),  low(t) = max(a0 - J t, a_min, af - J (T - t)).
// The largest displacement with a given velocity gain is high before low with a ramp of -J between,
// that is, clamp(r - J t, low(t), high(t)) for the one r that gives the gain (found by false
// position). All of it is piecewise linear; it is integrated between the crossings of its lines.
// Where its velocity passes v_max, a cruise replaces the middle. The smallest displacement is that
// of the mirrored axis.
#pragma once

#include "firmware/trajectory/axis_problem.h"

namespace hoof::tools::trajectory {

using AxisProblem = firmware::trajectory::AxisProblem<double>;

// What the end state may miss by (negative: must be clear of the border by).
struct EndSlack {
  double velocity;
  double position;
};

// `relative` to the size of the velocities and of the way on `axis` in `duration_s`.
EndSlack relative_slack(const AxisProblem& axis, double duration_s, double relative);

// How far inside the reachable ends the wanted one lies; negative: outside. Position: meaningful
// where velocity is not negative. Ramp: beyond the time the change of acceleration takes at least.
struct SlowMargins {
  double ramp;      // s
  double velocity;  // m/s or rad/s
  double position;  // m or rad
};

// For a start and target inside the limits, and a finite jerk limit.
SlowMargins slow_margins(const AxisProblem& axis, double duration_s);

// The same restrictions.
bool slowly_feasible(const AxisProblem& axis, double duration_s, const EndSlack& slack);

}  // namespace hoof::tools::trajectory
