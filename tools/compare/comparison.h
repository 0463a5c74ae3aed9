// Two recordings, signal by signal, moment by moment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/compare/tolerance.h"
#include "tools/log/signal_series.h"

namespace hoof::tools {

enum class SignalVerdict { kSame, kWithin, kOut, kOnlyA, kOnlyB };
const char* to_string(SignalVerdict verdict);

struct SignalComparison {
  std::string name;
  SignalVerdict verdict = SignalVerdict::kSame;
  Tolerance tolerance;
  std::size_t compared = 0;  // moments
  std::size_t outside = 0;   // of them out of tolerance
  double largest = 0;        // |B - A|
  double largest_at_s = 0;   // on A's time
  double rms = 0;
  std::optional<double> first_outside_s;  // time of the first divergence, on A's time
  // A's moments with both values, for a plot; not-a-number where B has none.
  std::vector<double> time_s, a, b, allowed;
  bool whole = false;
  std::vector<std::string> value_names;  // of texts: those of A, then new ones of B
};

struct CompareOptions {
  std::vector<ToleranceRule> tolerances;
  std::string align_signal;    // empty: by time
  double longest_shift_s = 1;  // of alignment by a signal
};

struct Comparison {
  double shift_s = 0;  // B's times were moved by this much: A's time = B's time + shift
  double overlap_from_s = 0, overlap_to_s = 0;
  double a_ends_s = 0, b_ends_s = 0;
  bool length_differs = false;  // one has more than the alignment explains
  std::vector<SignalComparison> signals;

  bool within() const;
};

/// A is the baseline: B is looked up at A's moments, between its own by a line, whole numbers and
/// texts by holding the last one. Only where both have values; a difference in length by more than
/// 2 % and 5 ms is a difference of its own.
/// @throws UserError where the signal to align by is missing or they do not overlap
Comparison compare(const std::vector<SignalSeries>& a, const std::vector<SignalSeries>& b,
                   const CompareOptions& options);

/// Shift of B, within +-longest_shift_s, at which the curves differ least in the mean square; at
/// least half of the shorter one must overlap.
double best_shift_s(const SignalSeries& a, const SignalSeries& b, double longest_shift_s);

}  // namespace hoof::tools
