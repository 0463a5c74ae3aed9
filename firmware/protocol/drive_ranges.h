// What a command or reply code of each drive means at its ends: one table for all drives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hoof::firmware::protocol {

enum class Drive : std::uint8_t { kToe = 0, kHip = 1, kKnee = 2 };
inline constexpr std::size_t kDriveCount = 3;
inline constexpr std::array<Drive, kDriveCount> kDrives{Drive::kToe, Drive::kHip, Drive::kKnee};

constexpr std::size_t index(Drive drive) {
  return static_cast<std::size_t>(drive);
}

/// Position, velocity and torque run from minus to plus the value, gains from zero.
struct DriveRange {
  float position_rad;
  float velocity_rad_s;
  float kp_Nm_rad;
  float kd_Nm_s_rad;
  float torque_Nm;
};

/// Toe: the ranges of the mini-cheetah command with the torque end of a 25 Nm class drive, which
/// a small AK drive can be ordered with.
///
/// Hip and knee: no drive of this command family is sold for them. Stance peaks reach 235 Nm (hip
/// of a 0.3 m + 0.3 m leg 0.5 m above the sand), so the torque end is 400 Nm, a custom build. Such
/// a joint needs less angle and speed and far more stiffness than a 24 Nm drive:
/// - +-3.2 rad holds a full turn of a joint, so an absolute encoder needs no turn count; one of
///   65536 codes is then 0.098 mrad, 0.05 mm at the foot.
/// - +-20 rad/s is ten times the 1.82 rad/s of the fastest stance path.
/// - kp to 20000 Nm/rad: 235 Nm then deflects the joint by 0.012 rad, 6 mm at the foot; with the
///   500 Nm/rad of the small drives it would be 0.47 rad.
/// - kd to 500 Nm s/rad is beyond critical damping of kp 20000 on 0.85 kg m2 (2 sqrt(17000) = 261).
inline constexpr std::array<DriveRange, kDriveCount> kDriveRanges{{
    {12.5f, 45.0f, 500.0f, 5.0f, 24.0f},
    {3.2f, 20.0f, 20000.0f, 500.0f, 400.0f},
    {3.2f, 20.0f, 20000.0f, 500.0f, 400.0f},
}};

}  // namespace hoof::firmware::protocol
