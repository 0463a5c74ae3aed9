#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/conceal/answer.h"
#include "tools/conceal/confidence.h"
#include "tools/conceal/pick.h"
#include "tools/conceal/truth.h"

namespace hoof::tools::conceal {

/// A case with what was answered; no answer counts as a wrong one.
struct GradedCase {
  TruthCase truth;
  std::optional<Answer> answer;
  std::string complaint;  ///< why there is no answer
};

/// One line of the contract's section 5. Shares are 0 to 1.
struct Measure {
  std::string name;
  double value = 0.0;
  int count = 0;
  Bounds bounds;
  double floor_low = 0.0, floor_high = 1.0;  ///< the value must lie within
  double aim_low = 0.0, aim_high = 1.0;
  bool is_share = true;  ///< printed in per cent

  bool meets_floor() const { return count > 0 && value >= floor_low && value <= floor_high; }
  bool meets_aim() const { return count > 0 && value >= aim_low && value <= aim_high; }
};

/// Lines 1 to 6: what any method that picks a verdict can be held to. `picks` is in the order of
/// the cases, empty where there is no answer.
std::vector<Measure> verdict_measures(const std::vector<TruthCase>& cases,
                                      const std::vector<std::optional<Pick>>& picks);

/// The other lines, which need the whole answer: channel, intervals of time and of parameters,
/// error removed, calibration.
std::vector<Measure> answer_measures(const std::vector<GradedCase>& cases);

/// Does the interval of a parameter hold the truth, or another reading of it? Angles go round.
bool holds_truth(const EffectParameter& truth, const AnsweredParameter& answered);

/// Time in both over time in either; 0 where both are empty.
double overlap(const std::vector<TimeInterval>& a, const std::vector<TimeInterval>& b);

/// Mean over ten equal bins of |how often right - how probable it was said to be|, by the number of
/// values in each (Naeini et al. 2015).
double calibration_error(const std::vector<std::pair<double, bool>>& said_and_right);

}  // namespace hoof::tools::conceal
