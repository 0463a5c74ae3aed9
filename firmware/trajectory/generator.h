// Online generator of jerk-limited, time-optimal, synchronised trajectories.
//
// Call update() once per control period. A running profile is kept while target, limits and modes
// stay the same; any change makes a new plan from the commanded state. A plan that fails is
// replaced by a stop within the acceleration and jerk limits, and its code is reported.
//
//   Generator<float, 3> generator(0.001f);
//   const Result result = generator.update(input, output);
//
// On a slow processor set_work_per_update(n) spreads a plan: at most n units are done per update()
// while the old profile goes on, and the new one starts, already complete, at the tick it was
// planned for. One unit validates and prepares one joint, tests or raises the common duration once,
// lays the pieces of one joint, or anchors them to its target; a plan of j joints takes 5 j of
// them, j + 1 more with phase synchronisation, and never more than Planner::most_units(j). Until
// its first plan is complete a moving start loses its acceleration at the jerk limit and goes on at
// its velocity. A stop is planned in units too: it begins 5 j / n updates after the one that finds
// the goal bad. What a unit costs on a Cortex-M4F is measured by tests/firmware/cost.
#pragma once

#include "firmware/trajectory/input.h"
#include "firmware/trajectory/planner.h"
#include "firmware/trajectory/result.h"
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
    // Before anything was ever planned a goal for another number of joints may still be given.
    if (!has_state_ || (!limits_known_ && !planning_ && input.joints != goal_.joints)) {
      adopt_state(input);
      if (work_per_update_ > 0) coast(input);
    }
    new_plan_ = false;
    // Where work is spread, comparing goals, or coasting, is the first update's share of it.
    const bool spent = work_per_update_ > 0 && !planning_;
    if (!planning_ && (!has_goal_ || !same_goal(input))) request(input);
    if (planning_ && !spent) continue_planning();
    advance(output);
    describe(output);
    return result();
  }

  // Plans from input's own start state at once, and makes it the running profile at time 0.
  // kWorking, or the failure (the running profile is then the stop from that state).
  Result plan(const InputType& input) {
    adopt_state(input);
    take(input);
    begin(Making::kGoal, 0);
    complete();
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
  enum class Making : std::uint8_t { kGoal, kStop };

  const Plan<Real, kMaxJoints>& running() const { return plans_[running_]; }

  static int joints_of(const InputType& input) {
    return minimum(maximum(input.joints, 0), kMaxJoints);
  }

  void adopt_state(const InputType& input) {
    Plan<Real, kMaxJoints>& plan = plans_[running_];
    plan.joints = joints_of(input);
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

  // What is followed until the first plan is ready.
  void coast(const InputType& input) {
    Plan<Real, kMaxJoints>& plan = plans_[running_];
    for (int i = 0; i < plan.joints; ++i) {
      plan.profile[i].coast(commanded_[i], input.max_jerk[i]);
      plan.duration_s = maximum(plan.duration_s, plan.profile[i].duration_s());
    }
    start_running();
    stopping_ = true;
    new_plan_ = false;
  }

  void take(const InputType& input) {
    goal_ = input;
    has_goal_ = true;
    validation_error_ = {};
  }

  void request(const InputType& input) {
    take(input);
    using PlannerType = Planner<Real, kMaxJoints>;
    begin(Making::kGoal,
          updates_for(PlannerType::usual_units(joints_of(input), input.synchronisation)));
  }

  int updates_for(int units) const {
    return work_per_update_ > 0 ? (units + work_per_update_ - 1) / work_per_update_ : 0;
  }

  // Begins a plan to be followed `updates` from now, from where the running profile will be then.
  void begin(Making making, int updates) {
    making_ = making;
    updates_left_ = updates_planned_ = updates;
    const bool stop = making == Making::kStop;
    planner_.begin(stop ? stop_goal_ : goal_, start_, plans_[1 - running_], stop);
    progress_ = Result::kPlanning;
    planning_ = true;
  }

  // One unit of planning.
  [[gnu::noinline]] void work() {
    const int joint = planner_.joint_to_prepare();
    if (joint >= 0) {
      if (making_ == Making::kGoal && !validated(joint)) {
        progress_ = Result::kInvalidInput;
        return;
      }
      start_[joint] = commanded_after(updates_left_, joint);
    }
    progress_ = planner_.work();
    const bool all_valid = joint >= 0 && joint + 1 == goal_.joints && making_ == Making::kGoal;
    if (all_valid) remember_limits();
  }

  bool validated(int joint) {
    if (joint == 0) {
      validation_error_ = validate_modes(goal_);
      const int running_joints = running().joints;
      if (!validation_error_ && goal_.joints != running_joints) {
        validation_error_ = {goal_.joints < running_joints ? Rule::kAtLeast : Rule::kAtMost,
                             Quantity::kJoints, -1, Real(goal_.joints), Real(running_joints)};
      }
    }
    if (!validation_error_) validation_error_ = validate_joint(goal_, joint);
    return !validation_error_;
  }

  // The limits a stop keeps are the latest that were valid.
  void remember_limits() {
    stop_goal_.joints = goal_.joints;
    stop_goal_.interface = Interface::kVelocity;
    stop_goal_.synchronisation = Synchronisation::kNone;
    stop_goal_.max_velocity = goal_.max_velocity;
    stop_goal_.min_velocity = goal_.min_velocity;
    stop_goal_.max_acceleration = goal_.max_acceleration;
    stop_goal_.min_acceleration = goal_.min_acceleration;
    stop_goal_.max_jerk = goal_.max_jerk;
    limits_known_ = true;
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
    if (work_per_update_ <= 0) return complete();
    if (updates_left_ == 0) {
      if (progress_ == Result::kWorking) return swap();
      // Blocked intervals cost more work than usual: once more, from a later start.
      const int most = Planner<Real, kMaxJoints>::most_units(joints_of(goal_));
      begin(making_, minimum(2 * updates_planned_, updates_for(most)));
    }
    for (int unit = 0; unit < work_per_update_ && progress_ == Result::kPlanning; ++unit) work();
    --updates_left_;
    if (is_failure(progress_)) fail(progress_);
  }

  // The plan, and the stop if it fails, at once.
  void complete() {
    while (planning_) {
      while (progress_ == Result::kPlanning) work();
      if (is_failure(progress_)) {
        fail(progress_);
      } else {
        swap();
      }
    }
  }

  // The completed plan becomes the running one, at once and as a whole.
  void swap() {
    running_ = 1 - running_;
    stopping_ = making_ == Making::kStop;
    if (!stopping_) plan_result_ = Result::kWorking;
    start_running();
  }

  // Stops within the last limits that were valid; at once when there never were any (then nothing
  // was ever commanded either).
  void fail(Result cause) {
    plan_result_ = cause;
    if (limits_known_) {
      begin(Making::kStop, updates_for(Planner<Real, kMaxJoints>::usual_units(
                               stop_goal_.joints, Synchronisation::kNone)));
      return;
    }
    Plan<Real, kMaxJoints>& plan = plans_[running_];
    for (int i = 0; i < plan.joints; ++i) plan.profile[i].rest(commanded_[i].position);
    plan.duration_s = 0;
    plan.straight_line = false;
    start_running();
    stopping_ = true;
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
  InputType goal_{};       // of the latest request; the planner reads it
  InputType stop_goal_{};  // standstill within the latest limits that were valid; targets are 0
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
  Making making_ = Making::kGoal;
  bool planning_ = false;
  Result progress_ = Result::kPlanning;
  int updates_planned_ = 0;
  int updates_left_ = 0;
};

}  // namespace hoof::firmware::trajectory
