// Least squares for costly rollouts.
#pragma once

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

/// Levenberg and Marquardt's, damped from the first step on: an undamped one that goes too far in
/// the valley of soil against effect costs as many rollouts as the way there.
/// @param held a coordinate that stays as it is; -1: none
Fit damped_fit(const Fitter& fitter, Fit fit, int iterations, const Fitter::Weights& weights,
               int held = -1);

}  // namespace hoof::tools
