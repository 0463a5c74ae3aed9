// First-order lag of the torque:
//   time_constant d(tau)/dt = tau_asked - tau
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class ActuatorLag final : public JointEffect {
 public:
  explicit ActuatorLag(std::span<const double> values) : time_constant_s_(values[0]) {}

  unsigned stages() const override { return kMotorStage; }

  void reset(double /*current_rms_A*/, double /*torque_rms_Nm*/) override {
    torque_Nm_ = 0;
    begun_ = false;
  }

  double motor_torque_Nm(double torque_Nm, double /*w*/, double dt_s) override {
    if (dt_s != dt_s_) {
      dt_s_ = dt_s;
      // Exact for a torque that is held during the step; the mean of the step is what acts.
      decay_ = std::exp(-dt_s / time_constant_s_);
      mean_ = time_constant_s_ / dt_s * (1 - decay_);
    }
    if (!begun_) torque_Nm_ = torque_Nm;
    begun_ = true;
    const double mean_Nm = torque_Nm + (torque_Nm_ - torque_Nm) * mean_;
    torque_Nm_ = torque_Nm + (torque_Nm_ - torque_Nm) * decay_;
    return mean_Nm;
  }

 private:
  double time_constant_s_;
  double torque_Nm_ = 0;
  double dt_s_ = 0, decay_ = 0, mean_ = 0;
  bool begun_ = false;
};

}  // namespace

EffectInfo actuator_lag_effect() {
  return {.name = "actuator_lag",
          .plug_in = PlugIn::kDrive,
          .summary = "torque that follows its command late and smoothed: a slow current loop",
          .equation = "time_constant * d(torque)/dt = command - torque",
          .source = "Franklin, Powell, Emami-Naeini, Feedback Control of Dynamic Systems, ch. 3",
          .parameters = {{"time_constant", "s", 1e-4, 1, 0.02, true, false, {0.005, 0.02, 0.06}}},
          .experiment = "a chirp of the goal up to 20 Hz, and steps of the torque",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<ActuatorLag>(values);
          }};
}

}  // namespace hoof::sim
