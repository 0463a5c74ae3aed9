// A stand-in for physics that the list does not hold.
//   Coulomb friction as a bristle: dz/dt = w (1 - stiffness z sign(w) / coulomb)
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class Presliding final : public JointEffect {
 public:
  explicit Presliding(std::span<const double> values) : stiffness_(values[0]) {}

  unsigned stages() const override { return kFrictionStage | kLinkStage; }

  void reset(double /*current_rms_A*/, double /*torque_rms_Nm*/) override {
    z_rad_ = last_s_ = coulomb_Nm_ = 0;
  }

  double friction_Nm(const JointMotion& motion) const override {
    coulomb_Nm_ = motion.coulomb_Nm;
    return -motion.coulomb_Nm;
  }
  double link_torque_Nm(double /*q*/, double w, double t) override {
    const double most_rad = coulomb_Nm_ / stiffness_;
    const double dt_s = t - last_s_;
    last_s_ = t;
    if (most_rad <= 0) return 0;
    // Implicit in z, so that any stiffness is stable.
    z_rad_ = (z_rad_ + w * dt_s) / (1 + std::abs(w) * dt_s / most_rad);
    return -stiffness_ * z_rad_;
  }

 private:
  double stiffness_;  // Nm/rad
  mutable double coulomb_Nm_ = 0;
  double z_rad_ = 0, last_s_ = 0;
};

}  // namespace

EffectInfo unlisted_presliding_effect() {
  return {
      .name = "unlisted_presliding",
      .plug_in = PlugIn::kJoint,
      .summary = "friction that gives way before it slides",
      .equation = "Coulomb friction as a bristle: dz/dt = w (1 - stiffness z sign(w) / coulomb)",
      .source = "Dahl, AIAA J. 14 (1976) 1675",
      .parameters = {{"stiffness", "Nm/rad", 0.05, 1e4, 5, true, false, {1, 5, 20}}},
      .experiment = "very small reversals about several angles",
      .listed = false,
      .make_joint = [](std::span<const double> values) {
        return std::make_unique<Presliding>(values);
      }};
}

}  // namespace hoof::sim
