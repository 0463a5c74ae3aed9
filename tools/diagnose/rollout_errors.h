// Free rollouts of all recordings and how far off they are.
#pragma once

#include <vector>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct Rollouts {
  RoleErrors errors;
  std::vector<Prediction> predictions;  // by recording
};

Rollouts roll_out(const Fitter& fitter, const Fit& fit, int threads);

/// By channel over all recordings: what a sensor's noise alone leaves.
Errors noise_floor(const Fitter& fitter);

/// The fit with its k-th effect gone, nothing refitted.
Fit without_effect(const RigModel& model, const Fit& fit, std::size_t k);

/// Of the fit recordings, each group's variance as the fit has it; samples as if independent.
double plain_log_likelihood(const Fitter& fitter, const Fit& fit);

}  // namespace hoof::tools
