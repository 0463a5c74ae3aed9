// A stand-in for physics that the list does not hold.
//   friction = coulomb + rate t

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class FrictionDrift final : public JointEffect {
 public:
  explicit FrictionDrift(std::span<const double> values) : rate_(values[0]) {}

  unsigned stages() const override { return kFrictionStage; }

  double friction_Nm(const JointMotion& motion) const override { return rate_ * motion.time_s; }

 private:
  double rate_;  // Nm/s
};

}  // namespace

EffectInfo unlisted_friction_drift_effect() {
  return {.name = "unlisted_friction_drift",
          .plug_in = PlugIn::kJoint,
          .summary = "friction that changes while the recording runs",
          .equation = "friction = coulomb + rate t",
          .source = "running-in and warming of grease",
          .parameters = {{"rate", "Nm/s", -1e3, 1e3, 0.01, false, false, {0.005}}},
          .experiment = "the same cycle again and again without a pause",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<FrictionDrift>(values);
          }};
}

}  // namespace hoof::sim
