#include "firmware/safety/heat.h"

#include "firmware/control/math.h"
#include "firmware/safety/limits.h"

namespace hoof::firmware::safety {

/// In steps of a tenth of a second: in steps of a millisecond a float near 1 would not change by
/// the 1e-7 that are due. Backward Euler: stable for a step of any length, and a rest of any length
/// cools less than in truth (1 / (1 + x) >= exp(-x)), never more.
void Heat::add(float torque_Nm, float heated_s, float elapsed_s) {
  constexpr float kStep_s = 0.1f;
  impulse_Nm2_s_ += torque_Nm * torque_Nm * heated_s;
  waiting_s_ += elapsed_s;
  if (waiting_s_ < kStep_s) return;
  const float x = waiting_s_ / time_s_;
  const float gain = impulse_Nm2_s_ / square_Nm2_ / time_s_;
  ratio_ = (ratio_ + gain) / (1.0f + x);
  impulse_Nm2_s_ = 0.0f;
  waiting_s_ = 0.0f;
}

float heat_ceiling_Nm(const DriveData& drive, float ratio, float most_Nm) {
  const float share = control::clamp((ratio - kWarm) / (1.0f - kWarm), 0.0f, 1.0f);
  return most_Nm + share * (drive.continuous_torque_Nm - most_Nm);
}

}  // namespace hoof::firmware::safety
