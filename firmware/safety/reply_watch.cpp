#include "firmware/safety/reply_watch.h"

#include <algorithm>

#include "firmware/control/math.h"

namespace hoof::firmware::safety {

using control::FaultBits;
using control::JointState;
using control::JointWish;
namespace fault = control::fault;

void ReplyWatch::start(std::int64_t now_ns) {
  *this = {};
  since_ns_ = now_ns;
}

FaultBits ReplyWatch::inspect(const JointLimits& limits, const DriveData& drive,
                              const JointState& state, const JointWish& passed, std::int64_t now_ns,
                              std::uint32_t ticks) {
  ticks_ += ticks;
  const bool heard = state.received && state.received_ns > since_ns_;
  const std::int64_t heard_ns = heard ? state.received_ns : since_ns_;
  if (now_ns - heard_ns > kFreshness_ns) return fault::kDriveLost;
  if (!heard) return 0;
  FaultBits found = state.error != 0 ? fault::kDriveError : 0;
  if (state.temperature_C > kHighestTemperature_C) found |= fault::kOverTemperature;
  const bool saturated = control::absolute(state.reading_rad) >= limits.end_of_range_rad;
  if (saturated) found |= fault::kImplausibleReply;
  const bool outside = state.position_rad < limits.lower_rad - kTravelMargin_rad ||
                       state.position_rad > limits.upper_rad + kTravelMargin_rad;
  if (state.referenced && outside) found |= fault::kOutsideTravel;
  if (compared_ && state.received_ns == last_.received_ns) return found;
  if (!motion_plausible(limits, state)) found |= fault::kImplausibleReply;
  if (stuck(limits, state)) found |= fault::kImplausibleReply;
  if (!follows(limits, drive, state, passed)) found |= fault::kNotFollowing;
  last_ = {state.reading_rad, state.velocity_rad_s, state.received_ns};
  compared_ = true;
  ticks_ = 0;
  return found;
}

/// A new reply against the one before: no farther than the drive can turn, and as far as the speeds
/// that it reports say. The second is a leaky integral of the difference, so that rounding, lag and
/// a knock are forgotten while a slipping encoder is not.
bool ReplyWatch::motion_plausible(const JointLimits& limits, const JointState& state) {
  if (!compared_) return true;
  const float moved_rad = state.reading_rad - last_.reading_rad;
  const float elapsed_s = control::seconds(state.received_ns - last_.received_ns);
  // Half a tick more: replies need not come at equal distances.
  const float reach_rad = limits.plausible_rad_s * (elapsed_s + 0.5f * control::kTick_s);
  // Control time stands still while SYNC pauses, the local clock runs on while a slow plant stands:
  // whatever lies between the two can be true.
  const float time_s = static_cast<float>(ticks_) * control::kTick_s;
  const float mean_rad_s = 0.5f * (state.velocity_rad_s + last_.velocity_rad_s);
  const float by_ticks_rad = mean_rad_s * time_s;
  const float by_clock_rad = mean_rad_s * elapsed_s;
  const auto [low_rad, high_rad] = std::minmax(by_ticks_rad, by_clock_rad);
  if (ticks_ <= kLongestGap_ticks) {
    drift_rad_ += moved_rad - control::clamp(moved_rad, low_rad, high_rad);
    drift_rad_ /= 1.0f + time_s / kDriftMemory_s;
  }
  return control::absolute(moved_rad) <= reach_rad &&
         control::absolute(drift_rad_) <= limits.drift_rad;
}

/// The motor's encoder sees its gear wind up, also where the joint itself is held by a stop or the
/// ground. A reading that stays on one code while the torque changes is that of a stuck encoder, or
/// of a rotor that is: the control would push on without end. The torque that has brought a rotor
/// to rest does not count.
bool ReplyWatch::stuck(const JointLimits& limits, const JointState& state) {
  if (!compared_ || state.reading_rad != last_.reading_rad) still_replies_ = 0;
  if (still_replies_ < kSettlingReplies) still_low_Nm_ = still_high_Nm_ = state.torque_Nm;
  ++still_replies_;
  still_low_Nm_ = std::min(still_low_Nm_, state.torque_Nm);
  still_high_Nm_ = std::max(still_high_Nm_, state.torque_Nm);
  return still_replies_ > kStuckReplies && still_high_Nm_ - still_low_Nm_ > limits.stuck_Nm;
}

/// The reply tells the torque that the drive made of a command a tick or two old; what the last one
/// asks at the reported state is nearly that, but for moments. So what counts is for how many ticks
/// more it is far off than near.
bool ReplyWatch::follows(const JointLimits& limits, const DriveData& drive, const JointState& state,
                         const JointWish& passed) {
  if (passed.action != control::DriveAction::kCommand) {
    astray_ticks_ = 0;
    return true;
  }
  const float asked_Nm = control::clamp(predicted_torque_Nm(passed.command, state),
                                        -drive.peak_torque_Nm, drive.peak_torque_Nm);
  if (control::absolute(state.torque_Nm - asked_Nm) > limits.following_Nm) {
    ++astray_ticks_;
  } else if (astray_ticks_ > 0) {
    --astray_ticks_;
  }
  return astray_ticks_ < kNotFollowingTicks;
}

}  // namespace hoof::firmware::safety
