// improved.toml: a nominal model's refitted numbers and the effects it lacked.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/rig_model.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct EffectsFile {
  std::vector<ActiveEffect> effects;    // in the order of the file
  std::map<std::string, double> setup;  // SI, by the names of RigModel::doubtful
};

/// @throws UserError for unknown effects and parameters, and values out of their bounds
EffectsFile read_effects_file(const std::filesystem::path& path);

/// The text of improved.toml: the effects that the verdict names, the setup as refitted beside
/// them.
/// @param data_sets their names, for a comment
std::string effects_file_text(const Verdict& verdict, const std::vector<std::string>& data_sets);

}  // namespace hoof::tools
