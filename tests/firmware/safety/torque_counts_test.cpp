// Every raw torque count of the wire from -1.5 to +1.5 of each joint's limit, through the gate.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/protocol/codec.h"
#include "firmware/safety/torque_gate.h"

using namespace hoof::firmware;
using control::DriveAction;
using control::Mode;
using safety::kLimits;

namespace {

constexpr int kSettlingTicks = 12;  // full swing at the slowest rate takes 7

control::PerJoint<control::JointState> resting_joints() {
  control::PerJoint<control::JointState> joints;
  for (auto& joint : joints) joint.received = joint.referenced = true;
  joints[2].position_rad = -1.0f;
  return joints;
}

control::Wish torque_wish(Mode mode, std::size_t joint, float torque_Nm) {
  control::Wish wish;
  wish.mode = mode;
  wish.joint[joint] = {DriveAction::kCommand, {.torque_Nm = torque_Nm}};
  return wish;
}

/// Calls visit(torque) for each count; neighbours of zero included, both signs.
template <typename Visit>
void for_every_count(std::size_t joint, Visit&& visit) {
  const float step_Nm = protocol::kCommandSignals[joint][4].scale;
  const int last = static_cast<int>(std::ceil(1.5f * kLimits[joint].torque_Nm / step_Nm));
  for (int count = -last; count <= last; ++count) {
    visit((static_cast<float>(count) + 0.5f) * step_Nm);
  }
}

}  // namespace

TEST_CASE("Every torque count within the limit passes unchanged; every one beyond is cut to it") {
  const auto joints = resting_joints();
  for (std::size_t joint = 0; joint < control::kJointCount; ++joint) {
    const float limit_Nm = kLimits[joint].torque_Nm;
    const protocol::Drive drive = protocol::kDrives[joint];
    const float half_step_Nm = 0.5f * protocol::kCommandSignals[joint][4].scale;
    for_every_count(joint, [&](float torque_Nm) {
      safety::TorqueGate gate({});
      const safety::Verdict* verdict = nullptr;
      for (int tick = 0; tick < kSettlingTicks; ++tick) {
        verdict = &gate.check(torque_wish(Mode::kReady, joint, torque_Nm), joints);
        // On the way no tick exceeds the limit either, nor the rate.
        REQUIRE(std::abs(verdict->torque_Nm[joint]) <= limit_Nm);
      }
      const float expected_Nm = std::clamp(torque_Nm, -limit_Nm, limit_Nm);
      // A correction of the feed-forward by the excess: two roundings of a float of some 500.
      REQUIRE(verdict->joint[joint].command.torque_Nm == Approx(expected_Nm).margin(1e-4));
      const bool beyond = std::abs(torque_Nm) > limit_Nm;
      REQUIRE(verdict->limits[joint] == (beyond ? safety::limit::kTorque : 0));
      // What the drive reads from the wire.
      protocol::DriveOrder order;
      const control::JointCommand& c = verdict->joint[joint].command;
      const auto frame = protocol::encode_command(drive, {0, 0, 0, 0, c.torque_Nm});
      REQUIRE(decode_command(drive, frame, order) == protocol::DecodeResult::kOk);
      REQUIRE(std::abs(order.command.torque_Nm) <= limit_Nm + half_step_Nm * 1.001f);
    });
  }
}

TEST_CASE("No torque count passes while the mode does not drive, or to another joint") {
  const auto joints = resting_joints();
  for (const Mode mode : {Mode::kOff, Mode::kEmergencyOff, Mode::kFault, Mode::kDampedStop}) {
    for (std::size_t joint = 0; joint < control::kJointCount; ++joint) {
      for_every_count(joint, [&](float torque_Nm) {
        safety::TorqueGate gate({});
        const auto& verdict = gate.check(torque_wish(mode, joint, torque_Nm), joints);
        REQUIRE(verdict.joint[joint].action == DriveAction::kExit);
        REQUIRE(verdict.limits[joint] == safety::limit::kRefused);
        REQUIRE(gate.interventions() == 1);
      });
    }
  }
}

TEST_CASE("No torque count passes a latched gate: damping goes instead") {
  const auto joints = resting_joints();
  for (std::size_t joint = 0; joint < control::kJointCount; ++joint) {
    for_every_count(joint, [&](float torque_Nm) {
      safety::TorqueGate gate({});
      gate.latch();
      const auto& verdict = gate.check(torque_wish(Mode::kRunning, joint, torque_Nm), joints);
      const control::JointCommand& c = verdict.joint[joint].command;
      REQUIRE(verdict.joint[joint].action == DriveAction::kCommand);
      REQUIRE(c.torque_Nm == 0.0f);
      REQUIRE(c.kp_Nm_rad == 0.0f);
      REQUIRE(c.kd_Nm_s_rad == kLimits[joint].stop_kd_Nm_s_rad);
      REQUIRE(verdict.limits[joint] == safety::limit::kLatched);
    });
  }
}

TEST_CASE("From tick to tick the torque changes by no more than the rate, both ways") {
  const auto joints = resting_joints();
  for (std::size_t joint = 0; joint < control::kJointCount; ++joint) {
    const float change_Nm = kLimits[joint].torque_rate_Nm_s * control::kTick_s;
    for (const float sign : {1.0f, -1.0f}) {
      safety::TorqueGate gate({});
      const float limit_Nm = kLimits[joint].torque_Nm;
      float previous_Nm = 0.0f;
      int limited = 0;
      for (int tick = 0; tick < 20; ++tick) {
        const float wish_Nm = tick < 10 ? sign * limit_Nm : -sign * limit_Nm;
        const auto& verdict = gate.check(torque_wish(Mode::kReady, joint, wish_Nm), joints);
        CHECK(std::abs(verdict.torque_Nm[joint] - previous_Nm) <= change_Nm * 1.0001f);
        limited += (verdict.limits[joint] & safety::limit::kTorqueRate) != 0;
        previous_Nm = verdict.torque_Nm[joint];
      }
      CHECK(previous_Nm == Approx(-sign * limit_Nm));
      // Up: floor(limit/change) steps fall short; down: twice the way.
      const int up = static_cast<int>(std::ceil(limit_Nm / change_Nm)) - 1;
      const int down = static_cast<int>(std::ceil(2.0f * limit_Nm / change_Nm)) - 1;
      CHECK(limited == up + down);
    }
  }
}
