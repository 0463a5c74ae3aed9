// One joint with a drive, as simple as can be: rotor with friction, an end stop, a load torque, and
// the drive's own law at 20 kHz.
#pragma once

#include <algorithm>
#include <cmath>

#include "firmware/control/types.h"

namespace hoof::firmware::control::test {

struct JointPlant {
  double inertia_kg_m2 = 0.012;
  double friction_Nm = 0.48;  // as the firmware's default toe drive
  double viscous_Nm_s_rad = 0.024;
  double torque_limit_Nm = 24.0;
  double stop_rad = -1e9;  // closed end stop: stiff spring and damper below it
  double load_Nm = 0.0;
  double q_rad = 0.0;
  double v_rad_s = 0.0;
  double motor_Nm = 0.0;

  /// A tick of 1 ms with the command held.
  void run(const JointCommand& c) {
    constexpr double kStep_s = 50e-6;
    for (int i = 0; i < 20; ++i) {
      const double wished_Nm = c.kp_Nm_rad * (c.position_rad - q_rad) +
                               c.kd_Nm_s_rad * (c.velocity_rad_s - v_rad_s) + c.torque_Nm;
      motor_Nm = std::clamp(wished_Nm, -torque_limit_Nm, torque_limit_Nm);
      double torque_Nm = motor_Nm + load_Nm - viscous_Nm_s_rad * v_rad_s;
      if (q_rad < stop_rad) torque_Nm += 5000.0 * (stop_rad - q_rad) - 5.0 * v_rad_s;
      move(torque_Nm, kStep_s);
    }
  }

  JointState state() const {
    JointState s;
    s.position_rad = static_cast<float>(q_rad);
    s.velocity_rad_s = static_cast<float>(v_rad_s);
    s.torque_Nm = static_cast<float>(motor_Nm);
    s.received = true;
    return s;
  }

 private:
  /// Coulomb friction stops the joint within a step, it never turns it round.
  void move(double torque_Nm, double step_s) {
    const double free_rad_s = v_rad_s + torque_Nm / inertia_kg_m2 * step_s;
    const double brake_rad_s = friction_Nm / inertia_kg_m2 * step_s;
    v_rad_s = std::copysign(std::max(std::abs(free_rad_s) - brake_rad_s, 0.0), free_rad_s);
    q_rad += v_rad_s * step_s;
  }
};

}  // namespace hoof::firmware::control::test
