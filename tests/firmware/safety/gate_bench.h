// A gate with three drives that answer every millisecond.
#pragma once

#include <catch2/catch.hpp>

#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::safety::test {

inline constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// Has watched healthy replies for a while; time in milliseconds.
struct Watched {
  TorqueGate gate{control::JointPresence{}};
  control::PerJoint<control::JointState> joints{};
  std::int64_t now_ms = 0;

  Watched() {
    for (control::JointState& joint : joints) joint.received = joint.referenced = true;
    place(2, -1.0f);
    for (int i = 0; i < 5; ++i) REQUIRE(next() == 0);
  }

  /// Angle and reading, as with a zero at 0.
  void place(std::size_t joint, float position_rad) {
    joints[joint].position_rad = joints[joint].reading_rad = position_rad;
  }

  /// One millisecond on; replies of all joints but `silent` come.
  control::FaultBits next(int silent = -1, control::Mode mode = control::Mode::kReady) {
    ++now_ms;
    for (std::size_t i = 0; i < control::kJointCount; ++i) {
      if (static_cast<int>(i) != silent) joints[i].received_ns = now_ms * kMillisecond_ns;
    }
    return gate.inspect(joints, mode, now_ms * kMillisecond_ns, 1);
  }
};

inline control::Wish wish_for(control::Mode mode, std::size_t joint, control::DriveAction action,
                              control::JointCommand c = {}) {
  control::Wish wish;
  wish.mode = mode;
  wish.joint[joint] = {action, c};
  return wish;
}

/// Makes the drive report a torque, while the foot is off, until its heat ratio is there.
/// @param now_ms time, which goes on by as long as that takes
inline void warm_up(TorqueGate& gate, std::size_t joint, float ratio, std::int64_t& now_ms) {
  control::PerJoint<control::JointState> joints{};
  joints[joint].received = true;
  joints[joint].torque_Nm = 1.5f * kDrives[joint].continuous_torque_Nm;
  int rounds = 0;  // 30000 warm a leg by 1.1
  while (gate.heat_ratio(static_cast<control::Joint>(joint)) < ratio) {
    if (++rounds > 50'000) FAIL("it does not warm up");
    now_ms += 20;
    joints[joint].received_ns = now_ms * kMillisecond_ns;
    gate.inspect(joints, control::Mode::kOff, now_ms * kMillisecond_ns, 1);
  }
}

}  // namespace hoof::firmware::safety::test
