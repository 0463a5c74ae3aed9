// A planned experiment in words, and as files for who makes it.
#pragma once

#include <string>

#include "tools/diagnose/planned_experiment.h"

namespace hoof::tools {

inline constexpr char kExperimentFile[] = "next_experiment.toml";
inline constexpr char kExperimentTable[] = "next_experiment.csv";

/// One sentence without a full stop: what to do, what is then expected where, and how sure that is.
std::string experiment_sentence(const PlannedExperiment& plan);

/// A data set of the contract's form, whole but for what is to be recorded.
/// @param data_sets the files that it is to be diagnosed with
std::string experiment_toml(const PlannedExperiment& plan,
                            const std::vector<std::string>& data_sets);

/// time and the channels to play, SI.
std::string experiment_csv(const PlannedExperiment& plan);

}  // namespace hoof::tools
