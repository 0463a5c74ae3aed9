// Machines reduced to what a closed form needs.
#pragma once

#include <cmath>

#include "tools/conceal/servo_machine.h"

namespace hoof::tests {

/// A pendulum without friction, its torque the input: none.
inline tools::conceal::ServoMachine free_pendulum() {
  tools::conceal::ServoMachine m;
  m.law = tools::conceal::DriveLaw::kTorque;
  m.payload_mass_kg = 0.6;
  m.payload_length_m = 0.2;
  m.arm_mass_kg = 0.1;
  m.armature_kgm2 = 0.004;
  m.coulomb_Nm = m.viscous_Nms_rad = 0.0;
  return m;
}

/// The same held by a position loop.
inline tools::conceal::ServoMachine held_pendulum() {
  tools::conceal::ServoMachine m = free_pendulum();
  m.law = tools::conceal::DriveLaw::kImpedance;
  m.kd_Nms_rad = 0.6;
  m.viscous_Nms_rad = 0.02;
  return m;
}

inline tools::conceal::ServoExercise idle(double duration_s, double step_s = 0.005) {
  tools::conceal::ServoExercise e;
  const int count = int(std::lround(duration_s / step_s));
  for (int i = 0; i <= count; ++i) e.times_s.push_back(i * step_s);
  return e;
}

inline tools::conceal::HiddenEffect hidden(
    const char* name, std::vector<tools::conceal::EffectParameter> parameters) {
  return {name, true, std::move(parameters)};
}

}  // namespace hoof::tests
