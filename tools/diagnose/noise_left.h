// Noise as the best hypothesis leaves it.
#pragma once

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

/// Nothing is believed to be better than this share of the sensor's variance.
inline constexpr double kLeastVariance = 0.8;

/// Sets each group's sigma and its share of independent samples to what this fit, judged, leaves.
/// What a recording that was not fitted leaves is no measure of noise: it takes its channel's.
void take_noise_left(Fitter& fitter, const Fit& best);

}  // namespace hoof::tools
