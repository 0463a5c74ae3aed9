// The paper's claims, one by one, as contrasts between runs on the same bed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/reproduce/outcome.h"
#include "tools/study/statistics.h"

namespace hoof::tools {

/// A number of the runs of some conditions on one bed, and the side of a bound that it must be on.
struct Contrast {
  std::string name;                     // "sinkage at 30 over 0 degrees, 60 kg, 0.1 m/s"
  std::vector<std::string> conditions;  // as of Cell
  std::function<double(const std::vector<Outcome>&)> effect;  // in their order
  bool below = true;  // claimed: effect < bound; else effect > bound
  double bound = 1;
  double paper = 0;    // NaN: not stated in numbers
  bool ratio = false;  // of two numbers that cannot be below nothing: counts by its logarithm
};

struct Claim {
  std::string name;       // on the command line: "30-best"
  std::string statement;  // what the paper says
  std::vector<Contrast> contrasts;
};

/// "30-best" first.
const std::vector<Claim>& paper_claims();

/// What the runs of one variation say of one contrast.
struct Evidence {
  /// Over beds, of the values or, where all are above 0 and the contrast is a ratio, of their
  /// logarithms; its confidence is half of the 95 % interval.
  Sample sample;
  bool logarithms = false;
  std::vector<int> beds;  // that have all conditions
  int infinite = 0;       // beds beside these: something over nothing

  double mean() const;  // of ratios the geometric one
  double low() const;   // of the 95 % interval; NaN of one bed
  double high() const;
  /// How far the mean is on the claimed side of the bound, in half intervals: over 1 it holds. NaN
  /// of one bed.
  double margin(const Contrast& contrast) const;
};

/// Nothing where no bed has all conditions.
std::optional<Evidence> weigh(const Contrast& contrast, const Outcomes& outcomes);

/// The whole 95 % interval lies on the claimed side of the bound, and no bed has something over
/// nothing where less was claimed. One bed has no interval.
bool holds(const Contrast& contrast, const Evidence& evidence);

enum class Finding { kHolds, kFails, kNotRun };
/// Of all contrasts of a claim: kHolds where each holds, kFails where one that was run does not.
Finding find(const Claim& claim, const Outcomes& outcomes);

enum class Verdict {
  kSupported,    // holds under the base and under every variation
  kFragile,      // holds under the base and fails under a variation
  kUnsupported,  // fails under the base
  kOpen          // the base or, with no failure, some variation was not run (to the end)
};
/// @param varied findings under the variations
Verdict judge(Finding base, const std::vector<Finding>& varied);

std::string to_string(Verdict verdict);

}  // namespace hoof::tools
