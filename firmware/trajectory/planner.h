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

  // Starts planning from `start` to the target in `input` (validated by the caller), with `plan`
  // to be filled. Neither may change until work() has finished.
  void begin(const InputType& input, const States& start, Plan<Real, kMaxJoints>& plan) {
    input_ = &input;
    start_ = &start;
    plan_ = &plan;
    plan.joints = input.joints;
    plan.straight_line = false;
    stage_ = Stage::kPrepare;
    joint_ = 0;
    tests_ = 0;
    agreed_ = 0;
    duration_s_ = input.minimum_duration_s;
    if (input.duration_step_s > 0) duration_s_ = next_step(duration_s_);
    axis_duration_s_.fill(duration_s_);
  }

  // Does one unit: prepares, searches or builds one axis. kPlanning until the plan is complete,
  // then kWorking, or the failure.
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
      case Stage::kStraighten:
        straighten();
        stage_ = Stage::kBuild;
        return Result::kPlanning;
      case Stage::kBuild:
        build(joint_);
        return next_joint() ? finish() : Result::kPlanning;
    }
    return Result::kNoSolution;
  }

  // The units a plan takes when no axis has a blocked interval in the way; work() may need more.
  static constexpr int usual_units(int joints) { return 4 * joints + 1; }

  // No plan takes more units than this.
  int most_units() const {
    return 2 * input_->joints + 1 + kTestsPerJoint * input_->joints * input_->joints;
  }

  // The shortest duration of one axis alone; after begin() and the first `joints` units.
  Real axis_minimum_s(int joint) const {
    Axis<Real> axis = axes_[joint];
    return axis.first_feasible(0);
  }

 private:
  enum class Stage : std::uint8_t { kPrepare, kSearchAlone, kSearchTogether, kStraighten, kBuild };

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
    const Real t = axes_[joint_].first_feasible(axis_duration_s_[joint_]);
    if (t < 0) return failure(joint_);
    if (!is_finite(t)) return Result::kOutOfRange;
    Real& duration_s = axis_duration_s_[joint_];
    if (t > duration_s * (1 + kRounding<Real>)) {
      duration_s = next_step(t);
      if (duration_s != t) {
        return ++tests_ > kTestsPerJoint ? Result::kNoCommonDuration : Result::kPlanning;
      }
    }
    duration_s_ = maximum(duration_s_, duration_s);
    tests_ = 0;
    if (next_joint()) stage_ = Stage::kBuild;
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
    stage_ =
        input_->synchronisation == Synchronisation::kPhase ? Stage::kStraighten : Stage::kBuild;
    return Result::kPlanning;
  }

  // Phase synchronisation: when all states are one vector times a scalar, solve for the scalar with
  // the tightest of the scaled limits. If it fits the common duration, every axis follows it.
  void straighten() {
    int reference = 0;
    for (int i = 1; i < input_->joints; ++i) {
      if (largest_term(problem(i)) > largest_term(problem(reference))) reference = i;
    }
    AxisProblem<Real> common = problem(reference);
    for (int i = 0; i < input_->joints; ++i) {
      if (axes_[i].brake().count > 0) return;
      if (!scale_of(i, reference, scale_[i])) return;
      tighten(problem(i).limits, scale_[i], common.limits);
    }
    const Real jerk = common.limits.max_jerk;
    if (jerk == 0 || common.limits.max_acceleration == 0 || common.limits.min_acceleration == 0) {
      return;
    }
    line_.prepare(input_->interface, common);
    const Real t = line_.first_feasible(duration_s_);
    plan_->straight_line = t >= 0 && t <= duration_s_ * (1 + kRounding<Real>);
  }

  static Real largest_term(const AxisProblem<Real>& axis) {
    return maximum(magnitude(axis.displacement),
                   maximum(magnitude(axis.velocity), magnitude(axis.target_velocity)));
  }

  // The factor from the reference's motion to joint i's, if all its terms agree on one.
  bool scale_of(int i, int reference, Real& scale) const {
    const AxisProblem<Real> a = problem(i);
    const AxisProblem<Real> r = problem(reference);
    const Real a_terms[] = {a.displacement, a.velocity, a.target_velocity, a.acceleration,
                            a.target_acceleration};
    const Real r_terms[] = {r.displacement, r.velocity, r.target_velocity, r.acceleration,
                            r.target_acceleration};
    const Real size = largest_term(r);
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

  void build(int i) {
    const bool line = plan_->straight_line;
    const Axis<Real>& axis = line ? line_ : axes_[i];
    axis.motion(mix_);
    const State<Real>& start = (*start_)[i];
    State<Real> end{input_->target_position[i], input_->target_velocity[i],
                    input_->target_acceleration[i]};
    using End = typename Profile<Real>::End;
    const bool position = input_->interface == Interface::kPosition;
    plan_->profile[i].build(start, end, axis.brake(), mix_, line ? scale_[i] : Real(1),
                            axis_duration_s_[i], position ? End::kAtTarget : End::kWhereItLeads);
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
  Axis<Real> line_;
  Mix<Real> mix_;
  Real duration_s_ = 0;
  int joint_ = 0;
  int tests_ = 0;
  int agreed_ = 0;
  Stage stage_ = Stage::kPrepare;
};

}  // namespace hoof::firmware::trajectory
