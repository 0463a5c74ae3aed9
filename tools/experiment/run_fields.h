// The sand under the foot in a run on grains: which moments are kept, and their files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/experiment/run_settings.h"
#include "tools/fields/field_recorder.h"
#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// Where the sand is cut lengthwise for drawings: through a row of spines, where there are spines.
double cut_y_m(const RunSettings& run);

class RunFields {
 public:
  /// @param experiment on grains; outlives this
  RunFields(const RunSettings& run, const sim::Experiment& experiment);

  /// After each tick, where the bed is what the run says.
  void tick(const sim::Observation& plant);
  std::string seen() const { return recorder_.save(); }
  void see_again(std::string_view bytes) { recorder_.restore(bytes); }

  /// Writes fields.json and the folder "fields" and puts the headline's moments under "fields" into
  /// the result. Nothing where the foot never touched. @throws UserError
  void write(const std::filesystem::path& folder, nlohmann::ordered_json& result);

 private:
  nlohmann::ordered_json described() const;
  const sim::SandBed& bed() const;

  const RunSettings& run_;
  const sim::Experiment& experiment_;
  FieldSetting setting_;
  FieldRecorder recorder_;
  sim::Observation last_;
};

}  // namespace hoof::tools
