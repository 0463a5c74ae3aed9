// The paper's numbers beside ours: each target, the band it is accepted in, and what the runs gave.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/study/statistics.h"

namespace hoof::tools {

/// What one run gave. Of the other kind: zero.
struct Outcome {
  double sinkage_mm = 0;  // largest displacement since first contact, spines count
  double fx_peak_N = 0, fz_at_fx_peak_N = 0;  // at that instant
  double coefficient = 0;
};

/// By condition, then by bed.
using Outcomes = std::map<std::string, std::map<int, Outcome>>;

enum class Standing {
  kPrediction,  // nothing of ours was set on it
  kInput,       // the geometry, which the paper does not give, was chosen by it
  kShown        // no band: the reference gives none
};

enum class Judgement { kInside, kOutside, kNotRun, kNoBand };

struct Comparison {
  std::string name;
  std::string unit;          // "mm", "N", "1"
  double paper = 0;          // its number, or that derived from its numbers
  double low = 0, high = 0;  // accepted; both zero: no band
  Standing standing = Standing::kPrediction;
  std::optional<Sample> ours = {};  // over beds; nothing: not run
  std::string note = {};            // what the reader must know

  Judgement judgement() const;
};

std::string to_string(Judgement judgement);
std::string to_string(Standing standing);

/// All targets that the outcomes can say anything of, and those that they could not, in a fixed
/// order. Ratios are of two runs on the same bed, and their scatter is over beds.
std::vector<Comparison> compare_with_paper(const Outcomes& outcomes);

}  // namespace hoof::tools
