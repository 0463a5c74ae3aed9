// Effects of the catalogue as hypotheses about a foot: each at one joint, or in its soil.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/multibody/rig.h"
#include "tools/diagnose/rig_model.h"
#include "tools/diagnose/verdict.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

/// "backlash" of "backlash@toe".
std::string plain_effect_name(std::string_view name);
/// "toe" of "backlash@toe"; empty where it has none.
std::string joint_of_effect(std::string_view name);

class FootEffects {
 public:
  /// Those for which this run's plant has a place and a session of seconds a chance to show.
  /// @param torque_rms_Nm as told on the bus, by joint
  void add_all(const RunSettings& run, const std::array<double, sim::kJointCount>& torque_rms_Nm);

  /// In the order in which they were made; they stay where they are.
  const std::vector<const sim::EffectInfo*>& list() const { return list_; }

  /// Of an effect of this list; of one of the catalogue as a file names it, none for all drives.
  std::optional<sim::Joint> joint(const ActiveEffect& effect) const;
  /// What torques among an effect's parameters are told in.
  double unit_of(const sim::EffectParameter& parameter) const;

 private:
  struct Hypothesis {
    sim::EffectInfo info;
    std::string name;  // what info.name looks at
    std::optional<sim::Joint> joint;
    double torque_unit_Nm = 1;
  };

  void add(const sim::EffectInfo& info, std::optional<sim::Joint> joint, const RunSettings& run,
           double torque_unit_Nm);

  std::deque<Hypothesis> hypotheses_;
  std::vector<const sim::EffectInfo*> list_;
};

/// The verdict in the contract's names: one entry for each effect, its joint beside it.
void name_joints(Verdict& verdict);

}  // namespace hoof::tools
