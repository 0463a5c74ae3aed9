// Ways of one hypothesis to the bottom of the valley that holds the truth, where rollouts make
// many.
#pragma once

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

/// Least squares in three rounds: the less a fit leaves, the less room the next gives it.
/// @param iterations at most, of the last round
Fit settle(const Fitter& fitter, Fit fit, int iterations);

/// Fits anew from other setups than that of `found`: as stated, half way to it, and its own, first
/// to as much of each recording as is followed; and from the stated one with each effect weaker
/// and stronger. A setup that stood in for the missing physics before the effect was there often
/// stays where a stuck fit needs it.
/// @param found its objective by fitter.weights()
/// @return the best, `found` among them
Fit fit_again(const Fitter& fitter, const Fit& found, int iterations);

}  // namespace hoof::tools
