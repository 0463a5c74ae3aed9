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
  kInput,       // what the paper does not give was chosen by it, or by numbers that it is made of
  kShown        // no band: the reference gives none
};

enum class Judgement { kInside, kOutside, kUndefined, kNotRun, kNoBand };

/// What became of a target with one thing changed (tools/reproduce/reasons.h).
struct Tried {
  std::string kind, name, what;  // "geometry", "long-spines", in words
  Sample with, without;          // of the same beds
  bool inside = false;           // with the change
  bool both = false;             // read by the sole beside
};

struct Comparison {
  std::string name;
  std::string unit;          // "mm", "N", "1"
  double paper = 0;          // its number, or that derived from its numbers
  double low = 0, high = 0;  // accepted; both zero: no band
  Standing standing = Standing::kPrediction;
  std::optional<Sample> ours = {};  // over beds; nothing: not run
  std::string note = {};            // what the reader must know
  double least_below_one = 0;       // accepted, beside the band: share of beds with a value below 1
  std::size_t undefined = 0;        // beds that were run and have no value, as a ratio to nothing
  /// Of one that is outside: what its runs' own beds say that they cannot tell, in sentences.
  std::vector<std::string> cannot_tell = {};
  /// With what was changed, whether it is outside or not.
  std::vector<Tried> tried = {};
  /// Of one that is outside: what another campaign found of the same target; empty: nothing.
  std::string elsewhere = {};

  Judgement judgement() const;
  /// The sentences as one text.
  std::string cannot_tell_text() const;
  /// Of one that is outside, as far as it was found: each change that brings it inside, where there
  /// is none each with which the reading by the sole does, or what came nearest. Empty: inside, or
  /// nothing was tried.
  std::string found() const;
  /// That, and what was found elsewhere.
  std::string reasons() const;
};

std::string to_string(Judgement judgement);
std::string to_string(Standing standing);

/// All targets that the outcomes can say anything of, and those that they could not, in a fixed
/// order. Ratios are of two runs on the same bed, and their scatter is over beds.
std::vector<Comparison> compare_with_paper(const Outcomes& outcomes);

}  // namespace hoof::tools
