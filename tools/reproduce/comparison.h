// The paper's numbers beside ours: each target, the band it is accepted in, and what the runs gave.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/reproduce/outcome.h"
#include "tools/study/statistics.h"

namespace hoof::tools {

enum class Standing {
  kPrediction,  // nothing of ours was set on it
  kInput,       // the geometry, which the paper does not give, was chosen by it
  kShown        // no band: the reference gives none
};

enum class Judgement { kInside, kOutside, kNotRun, kNoBand };

/// How the reason of a comparison begins; the sentences that follow are divided by "; ".
inline constexpr const char* kBedCannotTell = "the bed cannot tell: ";

struct Comparison {
  std::string name;
  std::string unit;          // "mm", "N", "1"
  double paper = 0;          // its number, or that derived from its numbers
  double low = 0, high = 0;  // accepted; both zero: no band
  Standing standing = Standing::kPrediction;
  std::optional<Sample> ours = {};  // over beds; nothing: not run
  std::string note = {};            // what the reader must know
  /// Of one that is outside, why, as far as it was found: what the runs' own beds say that they
  /// cannot tell. Empty: not found out.
  std::string reason = {};

  Judgement judgement() const;
};

std::string to_string(Judgement judgement);
std::string to_string(Standing standing);

/// All targets that the outcomes can say anything of, and those that they could not, in a fixed
/// order. Ratios are of two runs on the same bed, and their scatter is over beds.
std::vector<Comparison> compare_with_paper(const Outcomes& outcomes);

}  // namespace hoof::tools
