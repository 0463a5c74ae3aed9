#include "tools/trajectory/referee.h"

#include <cmath>
#include <optional>
#include <vector>

#include "tools/trajectory/slow_search.h"

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;
using firmware::trajectory::Synchronisation;

constexpr double kSlack = 1e-12;

class Referee {
 public:
  Referee(const Input& input, const GeneratorOf<double>& generator)
      : input_(input), generator_(generator) {}

  Verdict run() {
    if (input_.synchronisation != Synchronisation::kNone) {
      std::vector<int> all;
      for (int i = 0; i < input_.joints; ++i) all.push_back(i);
      return judge_together(all, generator_.duration_s());
    }
    Verdict worst = Verdict::kOptimal;
    for (int i = 0; i < input_.joints; ++i) {
      const Verdict verdict = judge_together({i}, generator_.profile(i).duration_s());
      if (verdict > worst) worst = verdict;
    }
    return worst;
  }

 private:
  Verdict judge_together(const std::vector<int>& joints, double found_s) {
    double bar = 1e-6 * found_s + 1e-8;
    for (const int i : joints) {
      if (std::isinf(input_.max_jerk[i])) bar = 1e-5 * found_s + 1e-8;
    }
    const std::optional<double> loose = first(joints, found_s, kSlack);
    if (!loose || *loose > found_s + bar) return Verdict::kTooShort;
    if (*loose >= found_s - bar) return Verdict::kOptimal;
    const std::optional<double> strict = first(joints, found_s, -kSlack);
    return strict && *strict < found_s - bar ? Verdict::kTooLong : Verdict::kUndecided;
  }

  std::optional<double> first(const std::vector<int>& joints, double found_s, double slack) const {
    std::vector<std::vector<Durations>> sets;
    for (const int i : joints) sets.push_back(durations(i, found_s * (1 + 2e-5) + 1e-12, slack));
    return first_common(sets, input_.minimum_duration_s, input_.duration_step_s);
  }

  std::vector<Durations> durations(int i, double end_s, double slack) const {
    SlowSearch search;
    search.velocity_only = input_.interface == Interface::kVelocity;
    search.slack = slack;
    const double brake_s = generator_.profile(i).brake_s();
    std::vector<Durations> set = slow_durations(after_brake(i), end_s - brake_s, search);
    for (Durations& d : set) {
      d.from_s += brake_s;
      d.to_s += brake_s;
    }
    if (starts_at_target(i)) set.insert(set.begin(), Durations{0, 0});
    return set;
  }

  bool starts_at_target(int i) const {
    return input_.interface == Interface::kPosition &&
           input_.position[i] == input_.target_position[i] &&
           input_.velocity[i] == input_.target_velocity[i] &&
           input_.acceleration[i] == input_.target_acceleration[i];
  }

  AxisProblem after_brake(int i) const {
    AxisProblem axis = axis_of(input_, i);
    if (std::isinf(axis.limits.max_jerk)) {
      const double a = std::max(axis.limits.max_acceleration, -axis.limits.min_acceleration);
      axis.limits.max_jerk = 1e8 * a;
    }
    const auto& profile = generator_.profile(i);
    if (!(profile.brake_s() > 0)) return axis;
    for (int k = 0; k < profile.pieces(); ++k) {
      const auto& piece = profile.piece(k);
      if (piece.begin_s < profile.brake_s()) continue;
      axis.displacement -= piece.state.position;
      axis.velocity = piece.state.velocity;
      // Without a jerk limit the acceleration may jump.
      axis.acceleration = std::isinf(input_.max_jerk[i]) ? 0 : piece.state.acceleration;
      break;
    }
    return axis;
  }

  const Input& input_;
  const GeneratorOf<double>& generator_;
};

}  // namespace

Verdict judge(const Input& input, const GeneratorOf<double>& generator) {
  return Referee(input, generator).run();
}

}  // namespace hoof::tools::trajectory
