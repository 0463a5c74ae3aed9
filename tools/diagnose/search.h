// Which hypotheses stand up to the recordings: nominal, each effect, pairs of effects.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

struct SearchOptions {
  int threads = 1;
  /// Share done and what is being done; false: stop.
  std::function<bool(double, const std::string&)> progress;
  /// Starts of each effect that are fitted, beside the nominal fit and beside the setup as stated.
  int fits_of_single = 2;
  int rough_iterations = 3;  // of each start, to choose those that are followed; 0: all are
  int follow_singles = 12, follow_pairs = 8;  // hypotheses that are followed to the end
  int pair_fits = 20;                         // pairs that are fitted
  int iterations = 10;
  int pair_bases = 4;   // single effects that others are tried beside
  int contenders = 16;  // fitted anew with the noise as the best of them leaves it
};

struct SearchResult {
  std::vector<Fit> fits;  // judged with the same groups; the first is the nominal model
};

/// Thrown where progress says stop.
struct SearchStopped {};

/// Fits what may explain the recordings. Leaves in `fitter` the groups' sigma and effective share
/// as the best hypothesis has them.
SearchResult search(Fitter& fitter, const SearchOptions& options);

/// Log likelihood with each group's variance as this fit has it, no smaller than the sensor's, less
/// half the logarithm of the samples for each parameter: for a first ranking.
double first_rank(const Fitter& fitter, const Fit& fit);

}  // namespace hoof::tools
