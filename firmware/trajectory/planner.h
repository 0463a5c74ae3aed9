// Plans a group of axes: finds the common duration, then builds every axis's profile. The work is
// cut into units so that a control loop can spread it over its ticks.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/trajectory/axis.h"
#include "firmware/trajectory/input.h"
#include "firmware/trajectory/profile.h"
#include "firmware/trajectory/result.h"

namespace hoof::firmware::trajectory {

template <typename Real, int kMaxJoints>
AxisLimits<Real> limits_of(const Input<Real, kMaxJoints>& input, int joint) {
  return {input.max_velocity[joint], input.min_velocity[joint], input.max_acceleration[joint],
          input.min_acceleration[joint], input.max_jerk[joint]};
}

// The profiles of all axes, ready to be sampled.
template <typename Real, int kMaxJoints>
struct Plan {
  int joints = 0;
  std::array<Profile<Real>, kMaxJoints> profile;
  Real duration_s = 0;
  bool straight_line = false;
};

template <typename Real, int kMaxJoints>
class Planner {
 public:
  using InputType = Input<Real, kMaxJoints>;
  using States = std::array<State<Real>, kMaxJoints>;

  // Starts planning from `start` to the target in `input`, with `plan` to be filled. `input` may
  // not change until work() has finished. Its values and `start` are read, joint by joint, by the
  // unit that prepares that joint: the caller may fill and validate them just before
  // (joint_to_prepare()). `always`: a joint whose limits forbid the motion stands still instead of
  // failing the plan.
  void begin(const InputType& input, const States& start, Plan<Real, kMaxJoints>& plan,
             bool always) {
    input_ = &input;
    start_ = &start;
    plan_ = &plan;
    always_ = always;
    plan.joints = input.joints;
    plan.straight_line = false;
    stage_ = Stage::kPrepare;
    joint_ = 0;
    tests_ = 0;
    agreed_ = 0;
    duration_s_ = input.minimum_duration_s;
    if (input.duration_step_s > 0) duration_s_ = next_step(duration_s_);
    axis_duration_s_.fill(duration_s_);
    stands_still_.fill(false);
  }

  // The joint the next work() will prepare, or -1.
  int joint_to_prepare() const { return stage_ == Stage::kPrepare ? joint_ : -1; }

  // Does one unit: prepares one axis, tests a duration with it, or builds a part of its profile.
  // kPlanning until the plan is complete, then kWorking, or the failure.
  Result work() {
    switch (stage_) {
      case Stage::kPrepare:
        axes_[joint_].prepare(input_->interface, problem(joint_));
        if (next_joint()) {
          stage_ = input_->synchronisation == Synchronisation::kNone ? Stage::kSearchAlone
                                                                     : Stage::kSearchTogether;
        }
        return Result::kPlanning;
      case Stage::kSearchAlone:
        return search_alone();
      case Stage::kSearchTogether:
        return search_together();
      case Stage::kCompare:
        compare(joint_);
        return Result::kPlanning;
      case Stage::kStraighten:
        straighten();
        stage_ = Stage::kMove;
        return Result::kPlanning;
      case Stage::kMove:
        move(joint_);
        return Result::kPlanning;
      case Stage::kLay:
        return lay(joint_);
      case Stage::kAnchor:
        plan_->profile[joint_].anchor_end();
        return next_profile();
    }
    return Result::kNoSolution;
  }

  // The units a plan takes when no axis has a blocked interval in the way; work() may need more.
  static constexpr int usual_units(int joints, Synchronisation synchronisation) {
    return 6 * joints + (synchronisation == Synchronisation::kPhase ? joints + 1 : 0);
  }

  // No plan takes more units than this.
  static constexpr int most_units(int joints) {
    return 5 * joints + 1 + kTestsPerJoint * joints * joints;
  }

  // The shortest duration of one axis alone; after begin() and the first `joints` units.
  Real axis_minimum_s(int joint) const {
    Axis<Real> axis = axes_[joint];
    return axis.first_feasible(0);
  }

 private:
  enum class Stage : std::uint8_t {
    kPrepare,
    kSearchAlone,
    kSearchTogether,
    kCompare,
    kStraighten,
    kMove,
    kLay,
    kAnchor
  };

  // An axis has two blocked intervals at most, so it can push the common duration up three times;
  // after every push all axes are tested again. The rest is for steps of duration that jump over
  // a short feasible interval, and for rounding.
  static constexpr int kTestsPerJoint = 8;

  bool next_joint() {
    ++joint_;
    if (joint_ < input_->joints) return false;
    joint_ = 0;
    return true;
  }

  AxisProblem<Real> problem(int i) const {
    const State<Real>& start = (*start_)[i];
    return {input_->target_position[i] - start.position,
            start.velocity,
            start.acceleration,
            input_->target_velocity[i],
            input_->target_acceleration[i],
            limits_of(*input_, i)};
  }

  // The first multiple of the duration step that is not below t (a rounding error below counts).
  Real next_step(Real t) const {
    const Real step = input_->duration_step_s;
    if (!(step > 0)) return t;
    const Real ratio = t / step;
    // Beyond this, and beyond 32 bits (a 64-bit conversion is software on the target), a step is
    // lost in the rounding of the duration.
    if (!(ratio < minimum(Real(2147483000), 1 / (8 * kEpsilon<Real>)))) return t;
    // A quarter of what the search accepts, lest it raise a step again that was rounded down to.
    const Real below = ratio - minimum(kRounding<Real> / 4 * ratio, Real(0.25));
    const Real whole = static_cast<Real>(static_cast<std::int32_t>(below));
    return (whole < below ? whole + 1 : whole) * step;
  }

  Result failure(int joint) const {
    if (axes_[joint].has_zero_limit()) return Result::kZeroLimits;
    const Real v_range = input_->max_velocity[joint] * input_->min_velocity[joint];
    return v_range == 0 ? Result::kZeroLimits : Result::kNoSolution;
  }

  Result search_alone() {
    Real t = axes_[joint_].first_feasible(axis_duration_s_[joint_]);
    if (!(t >= 0) || !is_finite(t)) {
      if (!always_) return t < 0 ? failure(joint_) : Result::kOutOfRange;
      stands_still_[joint_] = true;
      t = axis_duration_s_[joint_];
    }
    Real& duration_s = axis_duration_s_[joint_];
    if (t > duration_s * (1 + kRounding<Real>)) {
      duration_s = next_step(t);
      if (duration_s != t) {
        return ++tests_ > kTestsPerJoint ? Result::kNoCommonDuration : Result::kPlanning;
      }
    }
    duration_s_ = maximum(duration_s_, duration_s);
    tests_ = 0;
    if (next_joint()) stage_ = Stage::kMove;
    return Result::kPlanning;
  }

  // The common duration only ever grows: each axis in turn either accepts it or raises it to its
  // own next feasible one, until all have accepted the same.
  Result search_together() {
    const Real t = axes_[joint_].first_feasible(duration_s_);
    if (t < 0) {
      const Result cause = failure(joint_);
      return cause == Result::kZeroLimits && agreed_ > 0 && axes_[joint_].first_feasible(0) >= 0
                 ? Result::kNoCommonDuration
                 : cause;
    }
    if (!is_finite(t)) return Result::kOutOfRange;
    if (t <= duration_s_ * (1 + kRounding<Real>)) {
      ++agreed_;
    } else {
      duration_s_ = next_step(t);
      agreed_ = duration_s_ == t ? 1 : 0;
    }
    if (++tests_ > kTestsPerJoint * input_->joints * input_->joints) {
      return Result::kNoCommonDuration;
    }
    next_joint();
    if (agreed_ < input_->joints) return Result::kPlanning;
    joint_ = 0;
    axis_duration_s_.fill(duration_s_);
    stage_ = input_->synchronisation == Synchronisation::kPhase ? Stage::kCompare : Stage::kMove;
    return Result::kPlanning;
  }

  // Phase synchronisation: when all states are one vector times a scalar, solve for the scalar with
  // the tightest of the scaled limits. If it fits the common duration, every axis follows it.
  // compare() takes in one joint a call.
  void compare(int i) {
    if (i == 0) {
      reference_ = 0;
      for (int k = 1; k < input_->joints; ++k) {
        if (largest_term(k) > largest_term(reference_)) reference_ = k;
      }
      common_ = problem(reference_);
    }
    if (axes_[i].brake().count > 0 || !scale_of(i, reference_, scale_[i])) {
      joint_ = 0;
      stage_ = Stage::kMove;
      return;
    }
    tighten(limits_of(*input_, i), scale_[i], common_.limits);
    if (next_joint()) stage_ = Stage::kStraighten;
  }

  void straighten() {
    const AxisLimits<Real>& limits = common_.limits;
    if (limits.max_jerk == 0 || limits.max_acceleration == 0 || limits.min_acceleration == 0) {
      return;
    }
    line_.prepare(input_->interface, common_);
    const Real t = line_.first_feasible(duration_s_);
    plan_->straight_line = t >= 0 && t <= duration_s_ * (1 + kRounding<Real>);
  }

  Real largest_term(int i) const {
    const State<Real>& start = (*start_)[i];
    return maximum(magnitude(input_->target_position[i] - start.position),
                   maximum(magnitude(start.velocity), magnitude(input_->target_velocity[i])));
  }

  // The factor from the reference's motion to joint i's, if all its terms agree on one.
  bool scale_of(int i, int reference, Real& scale) const {
    const AxisProblem<Real> a = problem(i);
    const AxisProblem<Real> r = problem(reference);
    const Real a_terms[] = {a.displacement, a.velocity, a.target_velocity, a.acceleration,
                            a.target_acceleration};
    const Real r_terms[] = {r.displacement, r.velocity, r.target_velocity, r.acceleration,
                            r.target_acceleration};
    const Real size = largest_term(reference);
    if (!(size > 0)) return false;
    for (int k = 0; k < 3; ++k) {
      if (magnitude(r_terms[k]) == size) scale = a_terms[k] / r_terms[k];
    }
    // Collinear to the precision single-precision coordinates of a move have.
    const Real close = maximum(Real(1e-9), 100 * kEpsilon<Real>);
    for (int k = 0; k < 5; ++k) {
      const Real difference = a_terms[k] - scale * r_terms[k];
      if (magnitude(difference) > close * (magnitude(a_terms[k]) + size)) return false;
    }
    return true;
  }

  static void tighten(const AxisLimits<Real>& limits, Real scale, AxisLimits<Real>& common) {
    if (scale == 0) return;
    const Real by = 1 / magnitude(scale);
    const bool same = scale > 0;
    const auto lower_to = [](Real& bound, Real limit) { bound = minimum(bound, limit); };
    lower_to(common.max_velocity, by * (same ? limits.max_velocity : -limits.min_velocity));
    lower_to(common.max_acceleration,
             by * (same ? limits.max_acceleration : -limits.min_acceleration));
    lower_to(common.max_jerk, by * limits.max_jerk);
    common.min_velocity =
        maximum(common.min_velocity, -by * (same ? -limits.min_velocity : limits.max_velocity));
    common.min_acceleration = maximum(
        common.min_acceleration, -by * (same ? -limits.min_acceleration : limits.max_acceleration));
  }

  void move(int i) {
    const State<Real>& start = (*start_)[i];
    stage_ = Stage::kLay;
    if (stands_still_[i]) return plan_->profile[i].rest(start.position);
    const Axis<Real>& axis = plan_->straight_line ? line_ : axes_[i];
    axis.motion(mix_);
    const State<Real> end{input_->target_position[i], input_->target_velocity[i],
                          input_->target_acceleration[i]};
    plan_->profile[i].begin(start, end, axis.brake(), axis_duration_s_[i]);
  }

  Result lay(int i) {
    using End = typename Profile<Real>::End;
    const bool position = input_->interface == Interface::kPosition;
    if (!stands_still_[i]) {
      plan_->profile[i].lay(mix_, plan_->straight_line ? scale_[i] : Real(1),
                            position ? End::kAtTarget : End::kWhereItLeads);
    }
    if (!position) return next_profile();
    stage_ = Stage::kAnchor;
    return Result::kPlanning;
  }

  Result next_profile() {
    stage_ = Stage::kMove;
    return next_joint() ? finish() : Result::kPlanning;
  }

  Result finish() {
    plan_->duration_s = duration_s_;
    return Result::kWorking;
  }

  const InputType* input_ = nullptr;
  const States* start_ = nullptr;
  Plan<Real, kMaxJoints>* plan_ = nullptr;
  std::array<Axis<Real>, kMaxJoints> axes_;
  std::array<Real, kMaxJoints> axis_duration_s_{};
  std::array<Real, kMaxJoints> scale_{};
  std::array<bool, kMaxJoints> stands_still_{};
  AxisProblem<Real> common_{};  // of the straight line
  int reference_ = 0;           // the joint it is measured by
  Axis<Real> line_;
  Mix<Real> mix_;
  bool always_ = false;
  Real duration_s_ = 0;
  int joint_ = 0;
  int tests_ = 0;
  int agreed_ = 0;
  Stage stage_ = Stage::kPrepare;
};

}  // namespace hoof::firmware::trajectory
