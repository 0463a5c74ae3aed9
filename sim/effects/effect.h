// Optional physics: what a plant does beyond its nominal model. Off unless named.
//
// One file in sim/effects/laws per effect: its equation, its source, its parameters with units and
// bounds, and where it plugs in. The list of all is made from the files of that folder when the
// build is configured, so that a new effect touches no other file. The same object acts in the
// simulator of the foot, in the rigs of recordings and in the mismatch tool's hypotheses.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "sim/effects/joint_effect.h"
#include "sim/effects/soil_effect.h"

namespace hoof::sim {

enum class PlugIn { kBus, kDrive, kJoint, kSensor, kTerrain, kRig };

struct EffectParameter {
  std::string_view name = {};
  std::string_view unit = {};  // "1" for a pure number
  double low = 0;              // bounds, both allowed
  double high = 0;
  /// How large it may well be: the scale of a prior, and what a search steps by. Torques, here and
  /// in `starts`, are shares of the rms of the data's effort (a ceiling: of its peak), not Nm.
  double typical = 0;
  bool logarithmic = false;  // searched by its logarithm
  bool cyclic = false;       // an angle: low and high are the same
  /// Where searches start; all combinations are looked at. Empty: at `typical`.
  std::vector<double> starts = {};
};

struct EffectInfo {
  std::string_view name = {};
  PlugIn plug_in = PlugIn::kJoint;
  std::string_view summary = {};   // in words, for a reader of reports
  std::string_view equation = {};  // symbols as in the mismatch tool's contract
  std::string_view source = {};
  std::vector<EffectParameter> parameters = {};
  /// What would show it best: the experiment to run when recordings cannot decide.
  std::string_view experiment = {};
  /// False: physics that no user names, only a stand-in for what the list does not hold.
  bool listed = true;
  /// Null where the effect has no such side. Values in the order of `parameters`.
  std::function<std::unique_ptr<JointEffect>(std::span<const double>)> make_joint = {};
  std::function<std::unique_ptr<SoilEffect>(std::span<const double>)> make_soil = {};
};

/// All effects, in alphabetical order of their names.
const std::vector<EffectInfo>& effect_catalogue();

/// Null where there is no such effect.
const EffectInfo* find_effect(std::string_view name);

}  // namespace hoof::sim
