// Online generator of jerk-limited, time-optimal, synchronised trajectories.
//
// Call update() once per control period. A running profile is kept while target, limits and modes
// stay the same; any change makes a new plan from the commanded state. A plan that fails is
// replaced by a stop within the acceleration and jerk limits, and its code is reported.
//
//   Generator<float, 3> generator(0.001f);
//   const Result result = generator.update(input, output);
//
// On a slow processor set_work_per_update(n) spreads a plan: at most n units (one unit: one axis
// searched, tested or built) are done per update() while the old profile goes on, and the new one
// starts, already complete, at the tick it was planned for.
#pragma once

#include "firmware/trajectory/input.h"
#include "firmware/trajectory/result.h"
#include "firmware/trajectory/validate.h"

namespace hoof::firmware::trajectory {

template <typename Real, int kMaxJoints>
class Generator {
 public:
  using InputType = Input<Real, kMaxJoints>;
  using OutputType = Output<Real, kMaxJoints>;

  explicit Generator(Real period_s);

  // Advances one period. kWorking, kFinished (once, output is bit-equal to the target), then
  // kHolding; or the failure of the plan, while the fallback stop is followed to standstill.
  // The output is always a valid sample that keeps the acceleration and jerk limits.
  Result update(const InputType& input, OutputType& output);

  // Plans from input's own start state at once, and makes it the running profile at time 0.
  // kWorking, or the failure (the running profile is then the stop from that state).
  Result plan(const InputType& input);

  // Samples the running profile at time_s since its start, clamped to >= 0.
  void at_time(Real time_s, OutputType& output) const;

  // Units of planning per update(); 0 (the default): a plan is completed in the call that needs it.
  void set_work_per_update(int units);

  // Forgets the running profile: the next update() starts from the state in its input.
  void reset();

  Real duration_s() const;                         // of the running profile (the longest axis)
  Real axis_duration_s(int joint) const;           // of one axis of the running profile
  Real minimum_duration_s(int joint) const;        // of one axis alone, from the latest plan
  ValidationError<Real> validation_error() const;  // why the latest plan was kInvalidInput
};

}  // namespace hoof::firmware::trajectory
