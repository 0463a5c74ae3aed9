// The model alone, over recordings: hoof simulate.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/diagnose/effects_file.h"
#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

struct SimulatedRecording {
  const Recording* recording = nullptr;  // of the model
  std::vector<std::string> channels;
  Prediction prediction;
  std::vector<double> rmse;  // by channel, SI; NaN where nothing was compared
};

struct Simulation {
  std::vector<SimulatedRecording> recordings;
  std::map<std::string, double> fit, holdout;  // rmse by channel, over all recordings of the role
  std::vector<std::string> unused_setup;       // of the effects file: exact in the data set
};

/// Free rollouts of all recordings.
/// @throws UserError for effects that cannot act on this rig
Simulation simulate_rig(const RigModel& model, const EffectsFile& file);

/// "kp100_sin_sin.csv" of "runs/kp100_sin_sin.csv", each name once.
std::vector<std::string> prediction_file_names(const Simulation& simulation);

/// result.json of hoof simulate.
nlohmann::ordered_json simulation_json(const Simulation& simulation);

}  // namespace hoof::tools
