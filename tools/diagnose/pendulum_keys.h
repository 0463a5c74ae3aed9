// The numbers of a servo pendulum's [setup], and where they go.
#pragma once

#include <array>

#include "sim/rigs/servo_pendulum.h"

namespace hoof::tools {

struct PendulumKey {
  const char* name;
  double sim::PendulumSettings::*member;
  bool needed_by_all;
  bool duty, impedance;  // needed by these laws
};

inline constexpr std::array kPendulumKeys = {
    PendulumKey{"payload_mass", &sim::PendulumSettings::payload_mass_kg, true, false, false},
    PendulumKey{"payload_length", &sim::PendulumSettings::payload_length_m, true, false, false},
    PendulumKey{"arm_mass", &sim::PendulumSettings::arm_mass_kg, false, false, false},
    PendulumKey{"armature", &sim::PendulumSettings::armature_kg_m2, false, false, false},
    PendulumKey{"gravity", &sim::PendulumSettings::gravity_m_s2, false, false, false},
    PendulumKey{"coulomb", &sim::PendulumSettings::coulomb_Nm, false, false, false},
    PendulumKey{"viscous", &sim::PendulumSettings::viscous_Nm_s_rad, false, false, false},
    PendulumKey{"control_period", &sim::PendulumSettings::control_period_s, false, false, false},
    PendulumKey{"kp_duty", &sim::PendulumSettings::kp_duty, false, true, false},
    PendulumKey{"counts_per_rad", &sim::PendulumSettings::counts_per_rad, false, true, false},
    PendulumKey{"supply_voltage", &sim::PendulumSettings::supply_V, false, false, false},
    PendulumKey{"kt", &sim::PendulumSettings::kt_Nm_A, false, true, false},
    PendulumKey{"resistance", &sim::PendulumSettings::resistance_ohm, false, true, false},
    PendulumKey{"kp", &sim::PendulumSettings::kp_Nm_rad, false, false, true},
    PendulumKey{"kd", &sim::PendulumSettings::kd_Nm_s_rad, false, false, true},
    PendulumKey{"torque_limit", &sim::PendulumSettings::torque_limit_Nm, false, false, true},
};

}  // namespace hoof::tools
