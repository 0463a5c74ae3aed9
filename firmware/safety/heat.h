// How warm a drive's winding is, reckoned from the torque it reports: I2t, with cooling.
#pragma once

#include "firmware/safety/drive_data.h"

namespace hoof::firmware::safety {

/// Symbols: theta  heat ratio, rise of the winding over the rise at the continuous torque
///          T, T_c reported and continuous torque     tau  thermal time constant
/// First-order thermal model of a winding (one body; DriveData):
///   d theta / dt = (T^2 / T_c^2 - theta) / tau
/// At T_c for ever theta ends at 1. Ambient temperature is not known here: theta is the rise only,
/// and the drive's own sensor watches the rest.
class Heat {
 public:
  explicit constexpr Heat(const DriveData& drive)
      : time_s_(drive.thermal_time_s()),
        square_Nm2_(drive.continuous_torque_Nm * drive.continuous_torque_Nm) {}

  /// Adds a time in which the torque was held for heated_s and zero for the rest of elapsed_s.
  void add(float torque_Nm, float heated_s, float elapsed_s);

  /// theta as of the last full tenth of a second.
  float ratio() const { return ratio_; }

 private:
  float time_s_;
  float square_Nm2_;
  float ratio_ = 0.0f;
  float impulse_Nm2_s_ = 0.0f;  // integral of T^2 that has not been taken in yet
  float waiting_s_ = 0.0f;
};

/// What may be asked of a drive as warm as that: `most_Nm` (above the continuous torque) while
/// cool, the continuous torque when warmed through, on a line between.
float heat_ceiling_Nm(const DriveData& drive, float ratio, float most_Nm);

}  // namespace hoof::firmware::safety
