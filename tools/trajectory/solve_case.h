// Runs the generator once on an input, in either precision, and audits what it built.
#pragma once

#include "firmware/trajectory/generator.h"
#include "tools/trajectory/audit.h"
#include "tools/trajectory/case_table.h"

namespace hoof::tools::trajectory {

template <typename Real>
using InputOf = firmware::trajectory::Input<Real, kMaxJoints>;
template <typename Real>
using GeneratorOf = firmware::trajectory::Generator<Real, kMaxJoints>;

template <typename To, typename From>
InputOf<To> converted(const InputOf<From>& from) {
  InputOf<To> to;
  to.joints = from.joints;
  to.interface = from.interface;
  to.synchronisation = from.synchronisation;
  to.minimum_duration_s = static_cast<To>(from.minimum_duration_s);
  to.duration_step_s = static_cast<To>(from.duration_step_s);
  for (int i = 0; i < from.joints; ++i) {
    to.position[i] = static_cast<To>(from.position[i]);
    to.velocity[i] = static_cast<To>(from.velocity[i]);
    to.acceleration[i] = static_cast<To>(from.acceleration[i]);
    to.target_position[i] = static_cast<To>(from.target_position[i]);
    to.target_velocity[i] = static_cast<To>(from.target_velocity[i]);
    to.target_acceleration[i] = static_cast<To>(from.target_acceleration[i]);
    to.max_velocity[i] = static_cast<To>(from.max_velocity[i]);
    to.min_velocity[i] = static_cast<To>(from.min_velocity[i]);
    to.max_acceleration[i] = static_cast<To>(from.max_acceleration[i]);
    to.min_acceleration[i] = static_cast<To>(from.min_acceleration[i]);
    to.max_jerk[i] = static_cast<To>(from.max_jerk[i]);
  }
  return to;
}

inline firmware::trajectory::AxisProblem<double> axis_of(const Input& in, int i) {
  return {in.target_position[i] - in.position[i],
          in.velocity[i],
          in.acceleration[i],
          in.target_velocity[i],
          in.target_acceleration[i],
          limits_of(in, i)};
}

struct Solution {
  firmware::trajectory::Result result{};
  double duration_s = 0;
  bool straight_line = false;
  Audit audit;  // the worst over the axes
};

template <typename Real>
Solution solve_case(const InputOf<Real>& input, GeneratorOf<Real>& generator) {
  using firmware::trajectory::Interface;
  Solution solution;
  solution.result = generator.plan(input);
  if (is_failure(solution.result)) return solution;
  firmware::trajectory::Output<Real, kMaxJoints> output;
  generator.at_time(Real(0), output);
  solution.straight_line = output.straight_line;
  solution.duration_s = static_cast<double>(generator.duration_s());
  for (int i = 0; i < input.joints; ++i) {
    const auto& profile = generator.profile(i);
    const double end = input.interface == Interface::kPosition
                           ? static_cast<double>(input.target_position[i])
                           : static_cast<double>(profile.end().position);
    Auditor<Real> auditor(limits_of(input, i), input.interface);
    solution.audit.merge(auditor.run(profile, end - static_cast<double>(input.position[i]),
                                     static_cast<double>(input.target_velocity[i]),
                                     static_cast<double>(input.target_acceleration[i])));
  }
  return solution;
}

}  // namespace hoof::tools::trajectory
