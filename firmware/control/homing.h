// Finds the toe drive's zero at the closed end stop.
#pragma once

#include "firmware/control/settings.h"
#include "firmware/control/types.h"

namespace hoof::firmware::control {

enum class HomingResult : std::uint8_t { kSeeking = 0, kFound, kFailed };

/// Closes the toes slowly by speed (damping only, so that the push at the stop is bounded by
/// speed * damping), until the drive pushes without moving for a while. Angles are the drive's own.
class Homing {
 public:
  Homing(const HomingSettings& settings, float period_s)
      : settings_(settings), period_s_(period_s) {}

  void start();

  /// One tick. `command` is what the drive shall do while seeking.
  HomingResult step(const JointState& toe, JointCommand& command);

  /// After kFound: the drive's reading that stands for joint angle zero.
  float zero_rad() const { return zero_rad_; }

 private:
  HomingSettings settings_;
  float period_s_;
  float elapsed_s_ = 0.0f;
  float stalled_s_ = 0.0f;
  float zero_rad_ = 0.0f;
};

}  // namespace hoof::firmware::control
