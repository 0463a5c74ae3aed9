#include "tools/trajectory/random_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <memory>
#include <ostream>
#include <string>

#include "tools/trajectory/random_cases.h"
#include "tools/trajectory/referee.h"
#include "tools/trajectory/solve_case.h"

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;
using firmware::trajectory::Synchronisation;

constexpr double kDoubleOvershoot = 1e-9;  // issue 4
constexpr double kFloatOvershoot = 1e-4;
// States join, beyond what rounding explains. A lone motion (replan) is taken when its velocity
// agrees to rounding; its times and accelerations then agree to the square root of that.
constexpr double kJoin = 1e-6;
constexpr double kFloatJoin = 2e-3;

constexpr int kFamilies = static_cast<int>(Family::kCount);

struct Tally {
  long cases = 0;
  long broken = 0;
  double end_error = 0;
  double overshoot = 0;
  double float_overshoot = 0;
  long float_coarse = 0;  // a limit exceeded by more than the bar, but within float's rounding
  long slow = 0;
  long float_apart = 0;  // float's duration is not that of the rounded input: shorter or longer
  long undecided = 0;    // slow: the last digits of the input decide between two durations
  long twins_apart = 0;  // a twin's duration differs: next to a blocked interval, by rounding
};

// The same problem looked at otherwise; the duration must be the same (times time_factor).
struct Twin {
  Input input;
  double time_factor;
};

Twin mirrored(Input in) {
  for (int i = 0; i < in.joints; ++i) {
    for (auto* v : {&in.position, &in.velocity, &in.acceleration, &in.target_position,
                    &in.target_velocity, &in.target_acceleration}) {
      (*v)[i] = -(*v)[i];
    }
    const double v_max = in.max_velocity[i];
    in.max_velocity[i] = -in.min_velocity[i];
    in.min_velocity[i] = -v_max;
    const double a_max = in.max_acceleration[i];
    in.max_acceleration[i] = -in.min_acceleration[i];
    in.min_acceleration[i] = -a_max;
  }
  return {in, 1};
}

// Backwards in time and mirrored: the displacement and velocities stay, the accelerations turn.
Twin reversed(Input in) {
  for (int i = 0; i < in.joints; ++i) {
    std::swap(in.velocity[i], in.target_velocity[i]);
    const double a = in.acceleration[i];
    in.acceleration[i] = -in.target_acceleration[i];
    in.target_acceleration[i] = -a;
    const double a_max = in.max_acceleration[i];
    in.max_acceleration[i] = -in.min_acceleration[i];
    in.min_acceleration[i] = -a_max;
  }
  return {in, 1};
}

// Lengths times 3, times times 0.7: factors no binary number can hide.
Twin rescaled(Input in) {
  constexpr double kLength = 3;
  constexpr double kTime = 0.7;
  const auto scale = [&](Input::Vector& vector, int i, int order) {
    vector[i] *= kLength / std::pow(kTime, order);
  };
  for (int i = 0; i < in.joints; ++i) {
    scale(in.position, i, 0);
    scale(in.target_position, i, 0);
    for (auto* v : {&in.velocity, &in.target_velocity, &in.max_velocity, &in.min_velocity}) {
      scale(*v, i, 1);
    }
    for (auto* v :
         {&in.acceleration, &in.target_acceleration, &in.max_acceleration, &in.min_acceleration}) {
      scale(*v, i, 2);
    }
    scale(in.max_jerk, i, 3);
  }
  in.minimum_duration_s *= kTime;
  in.duration_step_s *= kTime;
  return {in, kTime};
}

class RandomChecker {
 public:
  RandomChecker(const RandomCheckOptions& options, std::ostream& out)
      : options_(options),
        out_(out),
        random_(options.seed),
        double_(std::make_unique<GeneratorOf<double>>(0.001)),
        float_(std::make_unique<GeneratorOf<float>>(0.001f)) {}

  int run() {
    out_ << "seed " << options_.seed << ", " << options_.count << " cases\n";
    for (long i = 0; i < options_.count; ++i) {
      const int family = static_cast<int>(i % kFamilies);
      check(static_cast<Family>(family), tallies_[family],
            (i / kFamilies) % options_.slow_every == 0);
    }
    return print();
  }

 private:
  void check(Family family, Tally& tally, bool slowly) {
    const Input input = random_input(family, random_);
    ++tally.cases;
    const Solution solution = solve_case(input, *double_);
    if (is_failure(solution.result)) return broken(tally, family, input, name(solution.result));
    tally.end_error = std::max(tally.end_error, solution.audit.end_error);
    tally.overshoot = std::max(tally.overshoot, solution.audit.overshoot);
    if (!(solution.audit.overshoot <= kDoubleOvershoot)) {
      broken(tally, family, input, "a limit is exceeded");
    }
    if (!(solution.audit.unexplained_end_error <= kJoin)) {
      broken(tally, family, input, "the states do not join");
    }
    if (slowly) compare_slowly(family, tally, input, solution);
    check_float(family, tally, input);
  }

  void check_float(Family family, Tally& tally, const Input& input) {
    const InputOf<float> rounded = converted<float>(input);
    const Solution solution = solve_case(rounded, *float_);
    if (is_failure(solution.result)) {
      return broken(tally, family, input, std::string("float: ") + name(solution.result));
    }
    tally.float_overshoot = std::max(tally.float_overshoot, solution.audit.overshoot);
    if (!(solution.audit.unexplained_overshoot <= kFloatOvershoot)) {
      broken(tally, family, input, "float: a limit is exceeded");
    }
    tally.float_coarse += solution.audit.overshoot > kFloatOvershoot;
    // Float cannot hold a metre in a motion of days at 1e5 m/s (family huge).
    if (family != Family::kHuge && !(solution.audit.unexplained_end_error <= kFloatJoin)) {
      broken(tally, family, input, "float: the states do not join");
    }
    // Next to a blocked interval the last bit of float decides; such cases are counted, not judged.
    if (is_failure(double_->plan(converted<double>(rounded)))) return;
    const double exact_s = double_->duration_s();
    tally.float_apart += std::fabs(solution.duration_s - exact_s) > 1e-3 * exact_s + 1e-6;
  }

  // Is the duration the first one the slow search finds feasible?
  void compare_slowly(Family family, Tally& tally, const Input& input, const Solution& solution) {
    ++tally.slow;
    const Verdict verdict = judge(input, *double_);
    tally.undecided += verdict == Verdict::kUndecided;
    if (verdict == Verdict::kTooLong) broken(tally, family, input, "there is a shorter duration");
    if (verdict == Verdict::kTooShort) broken(tally, family, input, "the duration is too short");
    if (family != Family::kStartOutside && family != Family::kLattice &&
        family != Family::kNoJerkLimit && input.interface == Interface::kPosition) {
      compare_twins(tally, input, solution);
    }
  }

  void compare_twins(Tally& tally, const Input& input, const Solution& solution) {
    for (const Twin& twin : {mirrored(input), reversed(input), rescaled(input)}) {
      if (is_failure(double_->plan(twin.input))) {
        ++tally.twins_apart;
        continue;
      }
      const double expected = solution.duration_s * twin.time_factor;
      if (std::fabs(double_->duration_s() - expected) > 1e-6 * expected + 1e-8) {
        ++tally.twins_apart;
      }
    }
  }

  void broken(Tally& tally, Family family, const Input& input, const std::string& why) {
    ++tally.broken;
    constexpr long kShown = 20;  // per family
    if (tally.broken > kShown) return;
    out_ << "BROKEN (" << name(family) << "): " << why << "\n" << as_command(input);
  }

  int print() {
    out_ << std::left << std::setw(20) << "family" << std::right << std::setw(9) << "cases"
         << std::setw(8) << "broken" << std::setw(12) << "end error" << std::setw(12) << "overshoot"
         << std::setw(12) << "float ov." << std::setw(8) << "coarse" << std::setw(12)
         << "float apart" << std::setw(8) << "slow" << std::setw(11) << "undecided" << std::setw(13)
         << "twins apart"
         << "\n";
    long total = 0;
    for (int i = 0; i < kFamilies; ++i) {
      const Tally& tally = tallies_[i];
      total += tally.broken;
      out_ << std::left << std::setw(20) << name(static_cast<Family>(i)) << std::right
           << std::setw(9) << tally.cases << std::setw(8) << tally.broken << std::scientific
           << std::setprecision(1) << std::setw(12) << tally.end_error << std::setw(12)
           << tally.overshoot << std::setw(12) << tally.float_overshoot << std::defaultfloat
           << std::setw(8) << tally.float_coarse << std::setw(12) << tally.float_apart
           << std::setw(8) << tally.slow << std::setw(11) << tally.undecided << std::setw(13)
           << tally.twins_apart << "\n";
    }
    out_ << (total == 0 ? "nothing is broken\n" : "BROKEN\n");
    return total == 0 ? 0 : 1;
  }

  RandomCheckOptions options_;
  std::ostream& out_;
  Random random_;
  std::unique_ptr<GeneratorOf<double>> double_;
  std::unique_ptr<GeneratorOf<float>> float_;
  std::array<Tally, kFamilies> tallies_{};
};

}  // namespace

int run_trajectory_random(const RandomCheckOptions& options, std::ostream& out) {
  return RandomChecker(options, out).run();
}

}  // namespace hoof::tools::trajectory
