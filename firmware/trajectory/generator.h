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
// starts, already complete, at the tick it was planned for. A unit is 1,100 instructions in the
// mean and 2,150 for the longest kind, building an axis (x86, -Os, float, callgrind over 2,000
// plans of three moving axes); at 1.5 cycles each, divisions and roots included, and 168 MHz, 20
// us.
#pragma once

#include "firmware/trajectory/input.h"
#include "firmware/trajectory/planner.h"
#include "firmware/trajectory/result.h"
#include "firmware/trajectory/stop_profile.h"
#include "firmware/trajectory/validate.h"

namespace hoof::firmware::trajectory {

template <typename Real, int kMaxJoints>
class Generator {
 public:
  using InputType = Input<Real, kMaxJoints>;
  using OutputType = Output<Real, kMaxJoints>;

  explicit Generator(Real period_s) : period_s_(period_s) {}

  // The planner keeps pointers into this object.
  Generator(const Generator&) = delete;
  Generator& operator=(const Generator&) = delete;

  // Advances one period. kWorking, kFinished (once, output is bit-equal to the target), then
  // kHolding; or the failure of the plan, while the fallback stop is followed to standstill and
  // after. The output is always a valid sample that keeps the acceleration and jerk limits.
  Result update(const InputType& input, OutputType& output) {
    if (!has_state_) adopt_state(input);
    new_plan_ = false;
    if (!planning_ && (!has_goal_ || !same_goal(input))) request(input);
    if (planning_) continue_planning();
    advance(output);
    describe(output);
    return result();
  }

  // Plans from input's own start state at once, and makes it the running profile at time 0.
  // kWorking, or the failure (the running profile is then the stop from that state).
  Result plan(const InputType& input) {
    adopt_state(input);
    if (accept(input)) {
      begin(0);
      while (progress_ == Result::kPlanning) progress_ = planner_.work();
      swap();
    }
    return plan_result_;
  }

  // Samples the running profile at time_s since its start; times below 0 count as 0.
  void at_time(Real time_s, OutputType& output) const {
    for (int i = 0; i < running().joints; ++i) {
      int hint = 0;
      put(running().profile[i].at(positive_part(time_s), hint), i, output);
    }
    describe(output);
    output.time_s = time_s;
  }

  // Units of planning per update(); 0 (the default): a plan is completed in the call that needs it.
  void set_work_per_update(int units) { work_per_update_ = units; }

  // Forgets the running profile: the next update() starts from the state in its input.
  void reset() {
    has_state_ = false;
    planning_ = false;
  }

  Real duration_s() const { return running().duration_s; }  // of the longest axis
  const Profile<Real>& profile(int joint) const { return running().profile[joint]; }

  // The shortest duration one axis alone could take, from the latest completed plan.
  Real minimum_duration_s(int joint) const { return planner_.axis_minimum_s(joint); }

  // Why the latest plan was kInvalidInput.
  const ValidationError<Real>& validation_error() const { return validation_error_; }

 private:
  const Plan<Real, kMaxJoints>& running() const { return plans_[running_]; }

  void adopt_state(const InputType& input) {
    Plan<Real, kMaxJoints>& plan = plans_[running_];
    plan.joints = minimum(maximum(input.joints, 0), kMaxJoints);
    for (int i = 0; i < plan.joints; ++i) {
      const auto finite_or_zero = [](Real value) { return is_finite(value) ? value : Real(0); };
      commanded_[i] = {finite_or_zero(input.position[i]), finite_or_zero(input.velocity[i]),
                       finite_or_zero(input.acceleration[i])};
      plan.profile[i].rest(commanded_[i].position);
    }
    plan.duration_s = 0;
    plan.straight_line = false;
    phase_ = Phase::kArrived;
    stopping_ = false;
    planning_ = false;
    has_state_ = true;
    has_goal_ = false;
    limits_known_ = false;
  }

  // Takes over the goal. False when it is refused; the stop is then running.
  bool accept(const InputType& input) {
    goal_ = input;
    has_goal_ = true;
    validation_error_ = validate(input);
    if (validation_error_) {
      fail(Result::kInvalidInput);
      return false;
    }
    stop_limits_ = input;
    if (!limits_known_ && work_per_update_ > 0) {
      limits_known_ = true;
      stop();  // a moving start does not wait for its first plan
    }
    limits_known_ = true;
    return true;
  }

  void request(const InputType& input) {
    if (accept(input)) begin(updates_for(Planner<Real, kMaxJoints>::usual_units(input.joints)));
  }

  int updates_for(int units) const {
    return work_per_update_ > 0 ? (units + work_per_update_ - 1) / work_per_update_ : 0;
  }

  // Begins a plan to be followed `updates` from now, from where the running profile will be then.
  void begin(int updates) {
    updates_left_ = updates;
    for (int i = 0; i < goal_.joints; ++i) start_[i] = commanded_after(updates, i);
    planner_.begin(goal_, start_, plans_[1 - running_]);
    progress_ = Result::kPlanning;
    planning_ = true;
  }

  State<Real> commanded_after(int updates, int i) const {
    State<Real> state = commanded_[i];
    if (updates == 0) return state;
    if (phase_ != Phase::kRunning) {
      state.position += state.velocity * period_s_ * static_cast<Real>(updates);
      return state;
    }
    int hint = hint_[i];
    return running().profile[i].at(static_cast<Real>(ticks_ + updates) * period_s_, hint).state;
  }

  void continue_planning() {
    if (updates_left_ == 0) {
      if (work_per_update_ <= 0) {
        while (progress_ == Result::kPlanning) progress_ = planner_.work();
      }
      if (progress_ != Result::kPlanning) return swap();
      // Blocked intervals cost more work than usual: once more, with time for the worst case.
      begin(updates_for(planner_.most_units()));
    }
    for (int unit = 0; unit < work_per_update_ && progress_ == Result::kPlanning; ++unit) {
      progress_ = planner_.work();
    }
    --updates_left_;
  }

  // The completed plan becomes the running one, at once and as a whole.
  void swap() {
    if (is_failure(progress_)) return fail(progress_);
    running_ = 1 - running_;
    stopping_ = false;
    plan_result_ = Result::kWorking;
    start_running();
  }

  void fail(Result cause) {
    plan_result_ = cause;
    stop();
  }

  // Replaces the running profile by a stop within the last limits that were valid; at once when
  // there never were any (then nothing was ever commanded either).
  void stop() {
    Plan<Real, kMaxJoints>& plan = plans_[running_];
    plan.duration_s = 0;
    plan.straight_line = false;
    for (int i = 0; i < plan.joints; ++i) {
      if (limits_known_ && i < stop_limits_.joints) {
        build_stop(commanded_[i], limits_of(stop_limits_, i), plan.profile[i]);
      } else {
        plan.profile[i].rest(commanded_[i].position);
      }
      plan.duration_s = maximum(plan.duration_s, plan.profile[i].duration_s());
    }
    stopping_ = true;
    start_running();
  }

  void start_running() {
    planning_ = false;
    ticks_ = 0;
    hint_.fill(0);
    phase_ = Phase::kRunning;
    new_plan_ = true;
  }

  void advance(OutputType& output) {
    const Plan<Real, kMaxJoints>& plan = running();
    if (phase_ != Phase::kRunning) {
      phase_ = Phase::kArrived;
      for (int i = 0; i < plan.joints; ++i) {
        commanded_[i].position += commanded_[i].velocity * period_s_;
        commanded_[i].acceleration = 0;
        put({commanded_[i], 0}, i, output);
      }
      return;
    }
    ++ticks_;
    Real time_s = static_cast<Real>(ticks_) * period_s_;
    if (time_s >= plan.duration_s * (1 - kRounding<Real>)) {
      time_s = plan.duration_s;
      phase_ = Phase::kArriving;
    }
    for (int i = 0; i < plan.joints; ++i) {
      const Sample<Real> sample = plan.profile[i].at(time_s, hint_[i]);
      commanded_[i] = sample.state;
      put(sample, i, output);
    }
  }

  Result result() const {
    if (is_failure(plan_result_)) return plan_result_;
    if (stopping_ || phase_ == Phase::kRunning) return Result::kWorking;
    return phase_ == Phase::kArriving ? Result::kFinished : Result::kHolding;
  }

  static void put(const Sample<Real>& sample, int i, OutputType& output) {
    output.position[i] = sample.state.position;
    output.velocity[i] = sample.state.velocity;
    output.acceleration[i] = sample.state.acceleration;
    output.jerk[i] = sample.jerk;
  }

  void describe(OutputType& output) const {
    output.time_s =
        phase_ == Phase::kRunning ? static_cast<Real>(ticks_) * period_s_ : running().duration_s;
    output.duration_s = running().duration_s;
    output.new_plan = new_plan_;
    output.stopping = stopping_;
    output.straight_line = running().straight_line;
    output.plan_result = plan_result_;
  }

  // NaN counts as equal to itself here: a refused goal is not planned again at every tick.
  static bool same(Real a, Real b) { return a == b || (a != a && b != b); }

  bool same_goal(const InputType& in) const {
    bool equal = in.joints == goal_.joints && in.interface == goal_.interface &&
                 in.synchronisation == goal_.synchronisation &&
                 same(in.minimum_duration_s, goal_.minimum_duration_s) &&
                 same(in.duration_step_s, goal_.duration_step_s);
    for (int i = 0; equal && i < in.joints && i < kMaxJoints; ++i) {
      equal = (in.interface == Interface::kVelocity ||
               same(in.target_position[i], goal_.target_position[i])) &&
              same(in.target_velocity[i], goal_.target_velocity[i]) &&
              same(in.target_acceleration[i], goal_.target_acceleration[i]) &&
              same(in.max_velocity[i], goal_.max_velocity[i]) &&
              same(in.min_velocity[i], goal_.min_velocity[i]) &&
              same(in.max_acceleration[i], goal_.max_acceleration[i]) &&
              same(in.min_acceleration[i], goal_.min_acceleration[i]) &&
              same(in.max_jerk[i], goal_.max_jerk[i]);
    }
    return equal;
  }

  enum class Phase : std::uint8_t { kRunning, kArriving, kArrived };

  Real period_s_;
  int work_per_update_ = 0;

  bool has_state_ = false;
  bool has_goal_ = false;
  bool limits_known_ = false;
  InputType goal_{};         // of the latest request; the planner reads it
  InputType stop_limits_{};  // the latest that was valid
  ValidationError<Real> validation_error_;

  std::array<Plan<Real, kMaxJoints>, 2> plans_;
  int running_ = 0;
  Phase phase_ = Phase::kArrived;
  std::int32_t ticks_ = 0;  // samples given of the running profile
  std::array<int, kMaxJoints> hint_{};
  std::array<State<Real>, kMaxJoints> commanded_;
  bool stopping_ = false;
  bool new_plan_ = false;
  Result plan_result_ = Result::kWorking;

  Planner<Real, kMaxJoints> planner_;
  std::array<State<Real>, kMaxJoints> start_;  // of the plan being made
  bool planning_ = false;
  Result progress_ = Result::kPlanning;
  int updates_left_ = 0;
};

}  // namespace hoof::firmware::trajectory
