// The experiment that tells hypotheses apart which the recordings do not.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/planned_experiment.h"

namespace hoof::tools {

/// A hypothesis that the recordings leave standing.
struct Rival {
  const Fit* fit = nullptr;  // judged: with its covariance
  double probability = 0;
};

/// Simulates what could be done on the machine with every rival as fitted, and chooses what tells
/// them apart best for its effort. Same arguments, same bytes, for any number of threads.
/// @param fitter of these data sets, its groups with the noise as the best hypothesis leaves it
/// @param rivals two or more, the most probable first
/// @return nothing where no experiment is known for the rig, or none that is safe; what is returned
///         may tell little: see its sigmas
std::optional<PlannedExperiment> design_experiment(const Fitter& fitter,
                                                   const std::vector<DataSet>& sets,
                                                   const std::vector<Rival>& rivals, int threads);

}  // namespace hoof::tools
