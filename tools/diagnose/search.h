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
  int fits_of_single = 2;   // starts of each effect that are followed to the end
  double least_gain = 0.3;  // of those after the first, of what the first promises
  int pair_fits = 20;       // pairs that are fitted
  int iterations = 10;
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
