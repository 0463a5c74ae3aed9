// What recordings of a servo pendulum show to be safe for it.
#pragma once

#include <vector>

#include "tools/diagnose/data_set.h"

namespace hoof::tools {

struct PendulumSafety {
  double low_rad = 0, high_rad = 0;                    // of goals; of positions where torque drives
  double position_low_rad = 0, position_high_rad = 0;  // as measured
  double speed_rad_s = 0;                              // as measured, but for the fastest percent
  double jump_rad = 0;                                 // of the goal; 0: it does not jump
  double torque_Nm = 0;                                // the largest recorded; 0: none is
  double step_s = 0;                                   // between samples
  bool torque_driven = false;

  double span_rad() const { return high_rad - low_rad; }
};

/// Over all recordings of the machine, held-out ones too.
PendulumSafety pendulum_safety(const std::vector<DataSet>& sets);

}  // namespace hoof::tools
