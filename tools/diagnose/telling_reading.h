// The one number of a recording that tells two hypotheses apart best.
#pragma once

#include <cstddef>
#include <utility>

#include "tools/diagnose/separation.h"

namespace hoof::tools {

struct SampleSpan {
  std::size_t first = 0, last = 0;  // both included
};

/// The mean over `late`, where `change` is set less the mean over `early`.
struct Reading {
  SampleSpan late, early;
  bool change = false;
  double sigmas = 0;  // by which the two hypotheses differ, of noise and both spreads
};

/// Among single samples, means of fortieths of the recording, and changes between those.
/// @param a, b of one channel, in time
Reading most_telling(const WhitePrediction& a, const WhitePrediction& b);

/// Value and 1-sigma of spread and noise, whitened.
std::pair<double, double> read(const Reading& reading, const WhitePrediction& prediction);

}  // namespace hoof::tools
