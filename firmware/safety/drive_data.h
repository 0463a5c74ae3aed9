// What each drive bears, by its data sheet: the only place in the firmware that says so. A test
// compares it with the drives of the plant (tests/firmware/safety/drive_data_test.cpp).
#pragma once

#include "firmware/control/types.h"

namespace hoof::firmware::safety {

/// All at the joint side of the gear. The winding is one heat capacity behind one resistance: lost
/// power copper_loss T^2 in, rise / thermal_resistance out. So the rise follows T^2 with the time
/// constant resistance * capacity, and a torque held for ever ends at resistance * loss * T^2.
struct DriveData {
  float peak_torque_Nm;        // clip of the drive's own electronics
  float continuous_torque_Nm;  // may be held for ever
  float copper_loss_W_Nm2;
  float thermal_resistance_K_W;
  float heat_capacity_J_K;

  constexpr float thermal_time_s() const { return thermal_resistance_K_W * heat_capacity_J_K; }
  constexpr float rise_K(float torque_Nm) const {
    return thermal_resistance_K_W * copper_loss_W_Nm2 * torque_Nm * torque_Nm;
  }
};

/// Class of a T-Motor AK80-9: 18 Nm peak, 9 Nm rated (its data sheet); 0.17 ohm and 0.105 Nm/A over
/// 9:1 make the loss; resistance and capacity are estimates from 0.485 kg of mass.
inline constexpr DriveData kToeDrive{
    .peak_torque_Nm = 18.0f,
    .continuous_torque_Nm = 9.0f,
    .copper_loss_W_Nm2 = 0.19f,
    .thermal_resistance_K_W = 3.0f,
    .heat_capacity_J_K = 100.0f,
};

/// Motor of Cassie's hip pitch on 26:1: 12.2 Nm at the motor. No rated torque is published; heat
/// values are estimates. 268 Nm end 65 K above ambient: at up to 35 degC of air the winding stays
/// below the 100 degC at which the foot stops.
inline constexpr DriveData kLegDrive{
    .peak_torque_Nm = 317.0f,
    .continuous_torque_Nm = 268.0f,
    .copper_loss_W_Nm2 = 0.0006f,
    .thermal_resistance_K_W = 1.5f,
    .heat_capacity_J_K = 600.0f,
};

inline constexpr control::PerJoint<DriveData> kDrives{kToeDrive, kLegDrive, kLegDrive};

}  // namespace hoof::firmware::safety
