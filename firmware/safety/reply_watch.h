// Whether one drive's replies are there, can be true, and show that the drive does as told.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"
#include "firmware/safety/drive_data.h"
#include "firmware/safety/limits.h"

namespace hoof::firmware::safety {

/// Looks at the drive's own reading, not at the joint angle: what a drive can report does not
/// depend on where homing puts the zero.
class ReplyWatch {
 public:
  /// Watching begins: the drive gets the freshness time to answer for the first time, and what it
  /// said before counts neither for nor against it.
  void start(std::int64_t now_ns);

  /// Once per tick.
  /// @param drive what the drive can
  /// @param passed what went to it in the last tick
  /// @param ticks SYNC numbers since the last call, 1 unless some were missed
  /// @return faults found now
  control::FaultBits inspect(const JointLimits& limits, const DriveData& drive,
                             const control::JointState& state, const control::JointWish& passed,
                             std::int64_t now_ns, std::uint32_t ticks);

 private:
  struct Reply {
    float reading_rad = 0.0f;
    float velocity_rad_s = 0.0f;
    std::int64_t received_ns = 0;
  };

  bool motion_plausible(const JointLimits& limits, const control::JointState& state);
  bool stuck(const JointLimits& limits, const control::JointState& state);
  bool follows(const JointLimits& limits, const DriveData& drive, const control::JointState& state,
               const control::JointWish& passed);

  std::int64_t since_ns_ = 0;
  Reply last_;
  bool compared_ = false;    // last_ is a reply of this watch
  std::uint32_t ticks_ = 0;  // since last_
  float drift_rad_ = 0.0f;
  int still_replies_ = 0;      // on one reading
  float still_low_Nm_ = 0.0f;  // torques on it, but for the first
  float still_high_Nm_ = 0.0f;
  int astray_ticks_ = 0;
};

}  // namespace hoof::firmware::safety
