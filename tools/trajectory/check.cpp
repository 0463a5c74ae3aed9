#include "tools/trajectory/check.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <memory>
#include <ostream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "tools/trajectory/case_table.h"
#include "tools/trajectory/referee.h"
#include "tools/trajectory/slow_check.h"
#include "tools/trajectory/solve_case.h"

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;
using firmware::trajectory::Result;

struct Bars {
  double relative;    // of the duration
  double absolute_s;  // of the duration
  double overshoot;
  double end_error;  // relative where the values on the way are above 1; see random_check.cpp

  double of(double duration_s) const { return relative * duration_s + absolute_s; }
};
constexpr Bars kDoubleBars{1e-6, 1e-8, 1e-9, 1e-6};
constexpr Bars kFloatBars{1e-3, 1e-6, 1e-4, 2e-3};

// The file's axis_check is the first duration at which the end position can be reached to within
// this (m or rad; tests/data/trajectory/README.md). It shows on moves below some micrometres.
constexpr double kCheckSlack = 1e-11;

struct FamilyTally {
  int rows = 0;
  int agreeing = 0;
  int by_slack = 0;     // true optimum; the check column is that of a target missed by its slack
  int by_rounding = 0;  // float: agree with the problem as rounded to float, not as written
  int unconfirmed = 0;  // solved; nothing confirmed to compare with
  int refused = 0;      // invalid rows that were refused, as they should be
  int coarse = 0;       // limits or target kept as well as the number format can, not to the bar
  int off = 0;
  int failures = 0;
  double worst_duration_error_s = 0;
  double worst_duration_error = 0;  // in units of the bar; both over the rows that agree or are off
  double worst_end_error = 0;
  double worst_overshoot = 0;

  void merge(const FamilyTally& other) {
    rows += other.rows;
    agreeing += other.agreeing;
    by_slack += other.by_slack;
    by_rounding += other.by_rounding;
    unconfirmed += other.unconfirmed;
    refused += other.refused;
    coarse += other.coarse;
    off += other.off;
    failures += other.failures;
    worst_duration_error_s = std::max(worst_duration_error_s, other.worst_duration_error_s);
    worst_duration_error = std::max(worst_duration_error, other.worst_duration_error);
    worst_end_error = std::max(worst_end_error, other.worst_end_error);
    worst_overshoot = std::max(worst_overshoot, other.worst_overshoot);
  }
};

// The reference refuses infinite targets only after trying; we do so in validate().
bool must_be_refused(const Case& c) {
  return c.family == "invalid" || bool(validate(c.input));
}

bool has_zero_limit(const Input& input) {
  for (int i = 0; i < input.joints; ++i) {
    if (input.max_velocity[i] == 0 || input.min_velocity[i] == 0 ||
        input.max_acceleration[i] == 0 || input.min_acceleration[i] == 0 ||
        input.max_jerk[i] == 0) {
      return true;
    }
  }
  return false;
}

// A refusal is right when the input is invalid, and where the reference too finds a zero limit in
// the way. Every other input has a solution.
bool may_fail(const Case& c, Result result) {
  if (result == Result::kInvalidInput) {
    return must_be_refused(c) || c.result == static_cast<int>(Result::kInvalidInput);
  }
  return c.result < 0 && has_zero_limit(c.input);
}

bool starts_at_target(const Input& input) {
  if (input.interface != Interface::kPosition) return false;
  for (int i = 0; i < input.joints; ++i) {
    if (input.position[i] != input.target_position[i] ||
        input.velocity[i] != input.target_velocity[i] ||
        input.acceleration[i] != input.target_acceleration[i]) {
      return false;
    }
  }
  return input.minimum_duration_s == 0;
}

// The duration to compare with, NaN when there is none.
double expected_duration(const Case& c) {
  if (starts_at_target(c.input)) return 0;
  const bool trust_check = c.agreement == Case::Agreement::kDiffer || c.result < 0;
  if (!trust_check) return c.duration_s;
  if (!std::isnan(c.group_check_s)) return c.group_check_s;
  return c.axis_check_s.size() == 1 ? c.axis_check_s[0] : std::numeric_limits<double>::quiet_NaN();
}

template <typename Real>
class Checker {
 public:
  Checker(const Bars& bars, std::ostream& details)
      : bars_(bars),
        details_(details),
        generator_(std::make_unique<GeneratorOf<Real>>(Real(0.001))),
        exact_(std::make_unique<GeneratorOf<double>>(0.001)) {}

  FamilyTally run(const Case& c) {
    tally_ = {};
    tally_.rows = 1;
    const InputOf<Real> input = converted<Real>(kIsFloat ? from_zero(c.input) : c.input);
    const Solution solution = solve_case(input, *generator_);
    if (is_failure(solution.result) && may_fail(c, solution.result)) {
      ++tally_.refused;
    } else if (must_be_refused(c)) {
      fail(c, std::string("was not refused: ") + name(solution.result));
    } else if (is_failure(solution.result)) {
      fail(c, name(solution.result));
    } else {
      compare(c, input, solution);
    }
    return tally_;
  }

 private:
  static constexpr bool kIsFloat = std::numeric_limits<Real>::digits < 30;

  void fail(const Case& c, const std::string& why) {
    ++tally_.failures;
    details_ << "  case " << c.id << " (" << c.family << "): " << why << "\n";
  }

  // Where zero is does not matter, but a float far from it cannot tell a small way.
  static Input from_zero(Input input) {
    for (int i = 0; i < input.joints; ++i) {
      input.target_position[i] -= input.position[i];
      input.position[i] = 0;
    }
    return input;
  }

  void compare(const Case& c, const InputOf<Real>& input, const Solution& solution) {
    tally_.worst_end_error = solution.audit.end_error;
    tally_.worst_overshoot = solution.audit.overshoot;
    judge_motion(c, solution.audit);
    const double expected = expected_duration(c);
    if (std::isnan(expected)) {
      ++tally_.unconfirmed;
      return;
    }
    const double error_s = std::fabs(solution.duration_s - expected);
    const double error = error_s / bars_.of(expected);
    const auto note_error = [&] {
      tally_.worst_duration_error_s = error_s;
      tally_.worst_duration_error = error;
    };
    if (error <= 1) {
      ++tally_.agreeing;
      note_error();
    } else if (within_slack(c, solution.duration_s, expected)) {
      ++tally_.by_slack;
      details_ << "  case " << c.id << " (" << c.family << "): " << std::setprecision(12)
               << solution.duration_s << " s is the optimum; the check column, " << expected
               << " s, that of a target missed by 1e-11\n";
    } else if (kIsFloat && fits_rounded(input, solution, expected)) {
      ++tally_.by_rounding;
    } else {
      ++tally_.off;
      note_error();
      details_ << "  case " << c.id << " (" << c.family << "): " << std::setprecision(12)
               << solution.duration_s << " s, expected " << expected << " s\n";
    }
  }

  void judge_motion(const Case& c, const Audit& audit) {
    if (!(audit.unexplained_overshoot <= bars_.overshoot)) fail(c, "a limit is exceeded");
    // Float cannot hold a metre in a motion of days at 1e5 m/s.
    const bool beyond_float = kIsFloat && c.family == "huge";
    if (!beyond_float && !(audit.unexplained_end_error <= bars_.end_error)) {
      fail(c, "the target is missed");
    }
    if (audit.overshoot > bars_.overshoot || audit.end_error > bars_.end_error) {
      ++tally_.coarse;
      details_ << "  case " << c.id << " (" << c.family << "): coarse, end error "
               << std::setprecision(2) << audit.end_error << ", overshoot " << audit.overshoot
               << "\n";
    }
  }

  // Is the expected duration the first one that reaches the target to within the column's slack,
  // and ours the first one that reaches it? Both by the slow check, which shares nothing with the
  // solver.
  bool within_slack(const Case& c, double duration_s, double expected) {
    if (c.agreement != Case::Agreement::kDiffer || c.input.joints != 1) return false;
    if (c.input.interface != Interface::kPosition) return false;
    const AxisProblem axis = axis_of(c.input, 0);
    const EndSlack slack{kCheckSlack, kCheckSlack};
    const double bar = kDoubleBars.of(expected);
    const bool first = slowly_feasible(axis, expected + bar, slack) &&
                       !slowly_feasible(axis, expected - bar, slack);
    if (!first || is_failure(exact_->plan(c.input))) return false;
    const double exact_s = exact_->duration_s();
    return judge(c.input, *exact_) <= Verdict::kUndecided &&
           std::fabs(duration_s - exact_s) <= bars_.of(exact_s);
  }

  // Rounding to float poses another problem, and next to a blocked interval its duration may be
  // quite another one. The float result is right when it is that of the rounded input; or when it
  // is shorter and reaches the target as well as float can tell, that is, when it takes a motion
  // that the last bit of the start or target opens or closes.
  bool fits_rounded(const InputOf<Real>& input, const Solution& solution, double expected) {
    if (solution.duration_s < expected && solution.audit.end_error <= bars_.relative) return true;
    const Input rounded = converted<double>(input);
    if (is_failure(exact_->plan(rounded))) return false;
    const double exact_s = exact_->duration_s();
    return std::fabs(solution.duration_s - exact_s) <= bars_.of(exact_s);
  }

  Bars bars_;
  std::ostream& details_;
  std::unique_ptr<GeneratorOf<Real>> generator_;
  std::unique_ptr<GeneratorOf<double>> exact_;
  FamilyTally tally_;
};

void print_row(const std::string& name, const FamilyTally& tally, std::ostream& out) {
  out << std::left << std::setw(18) << name << std::right << std::setw(6) << tally.rows
      << std::setw(7) << tally.agreeing << std::setw(7) << tally.by_slack << std::setw(9)
      << tally.by_rounding << std::setw(9) << tally.refused << std::setw(8) << tally.unconfirmed
      << std::setw(7) << tally.coarse << std::setw(5) << tally.off << std::setw(9) << tally.failures
      << std::scientific << std::setprecision(1) << std::setw(9) << tally.worst_duration_error_s
      << std::setw(9) << tally.worst_duration_error << std::setw(11) << tally.worst_end_error
      << std::setw(11) << tally.worst_overshoot << std::defaultfloat << "\n";
}

// True when every bar is kept.
template <typename Real>
bool check_precision(const std::string& title, const Bars& bars, const std::vector<Case>& cases,
                     std::ostream& out) {
  out << title << "\n"
      << std::left << std::setw(18) << "family" << std::right << std::setw(6) << "rows"
      << std::setw(7) << "agree" << std::setw(7) << "slack" << std::setw(9) << "rounded"
      << std::setw(9) << "refused" << std::setw(8) << "solved" << std::setw(7) << "coarse"
      << std::setw(5) << "off" << std::setw(9) << "failures" << std::setw(9) << "dT [s]"
      << std::setw(9) << "dT/bar" << std::setw(11) << "end error" << std::setw(11) << "overshoot"
      << "\n";
  std::ostringstream details;
  Checker<Real> checker(bars, details);
  std::map<std::string, FamilyTally> families;
  FamilyTally all;
  for (const Case& c : cases) {
    const FamilyTally tally = checker.run(c);
    families[c.family].merge(tally);
    all.merge(tally);
  }
  for (const auto& [name, tally] : families) print_row(name, tally, out);
  print_row("all", all, out);
  out << details.str() << "\n";
  return all.off == 0 && all.failures == 0;
}

}  // namespace

int run_trajectory_check(const std::string& path, std::ostream& out) {
  std::vector<Case> cases;
  try {
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot be opened");
    cases = read_cases(in);
  } catch (const std::runtime_error& error) {
    out << path << ": " << error.what() << "\n";
    return 2;
  }
  const bool double_kept = check_precision<double>("double (bar: 1e-6 T + 1e-8 s, limits 1e-9)",
                                                   kDoubleBars, cases, out);
  const bool float_kept =
      check_precision<float>("float (bar: 1e-3 T + 1e-6 s, limits 1e-4)", kFloatBars, cases, out);
  out << "agree: within the bar of the file's duration, plainly compared\n"
         "slack: the file's check column reaches the target to 1e-11 only; the plan is the "
         "optimum,\n"
         "       by the slow search\n"
         "rounded: float only; agrees with the input as rounded to float, or is shorter and "
         "reaches the\n"
         "         target as well as float can tell\n"
         "refused: rightly, as invalid or forbidden by a zero limit\n"
         "solved: the file has no duration to compare with\n"
         "coarse: limit or target missed by more than the bar, by no more than rounding of the "
         "largest\n"
         "        value on the way explains\n"
      << (double_kept && float_kept ? "every bar is kept\n" : "A BAR IS MISSED\n");
  return double_kept && float_kept ? 0 : 1;
}

}  // namespace hoof::tools::trajectory
