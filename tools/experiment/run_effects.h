// What a run's plant does beyond its nominal model, and numbers of it that were refitted: the
// sections [effects] and [setup] of its settings, as `hoof diagnose` writes them into
// improved.toml.
//
//   [effects.backlash]
//   gap = 0.03         # the parameters of the effect, SI, all of them
//   joint = "toe"      # of an effect at a joint: toe, hip or knee; without it all drives of the
//   run
//
//   [setup]            # SI; the plant's only: the firmware is not told
//   soil_stiffness = 2.1e7
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/config/settings.h"
#include "sim/coupling/plant.h"
#include "sim/effects/effect.h"
#include "sim/multibody/foot.h"
#include "sim/terrain/rft_terrain.h"

namespace hoof::tools {

struct RunSettings;

struct RunEffect {
  const sim::EffectInfo* info = nullptr;
  std::vector<double> values;       // in the order of info->parameters
  std::optional<sim::Joint> joint;  // of an effect at a joint; none: all drives of the run
};

/// Numbers of the plant that an operator may doubt, by their names in [setup]; SI.
struct SetupNumber {
  std::string name;
  double low = 0;
  double high = 0;
};
const std::vector<SetupNumber>& setup_numbers();

/// Null where this run has no such number (the soil's on a rigid floor, the hip's without a leg).
double* find_setup_number(RunSettings& run, const std::string& name);

/// Merges a file of effects into the tree of a run's settings.
/// @throws sim::ConfigError naming file, line, key
void merge_effects(const std::string& file, sim::Settings& tree);

/// Reads [effects] and [setup] of run.tree into `run`, which is complete but for them.
/// @throws sim::ConfigError naming file, line, key and what is wrong
void read_run_effects(RunSettings& run);

/// Why this run's plant has no place for an effect; empty: it has.
std::string misfit(const RunSettings& run, const RunEffect& effect);

/// The foot as its effects leave it.
sim::Foot foot_with_effects(const RunSettings& run);
void add_soil_effects(const RunSettings& run, sim::RftTerrain& terrain);
void add_joint_effects(const RunSettings& run, sim::Plant& plant);

/// One line each, for people: "backlash at the toe", "gap 0.03 rad".
struct EffectText {
  std::string name, values;
};
std::vector<EffectText> effect_texts(const RunSettings& run);

/// The same as a file that --effects takes. @param head its first line, a comment
std::string effects_toml(const RunSettings& run, const std::string& head);

}  // namespace hoof::tools
