// Every raw torque count of the wire from -1.5 to +1.5 of each joint's limit, through the gate:
// cool and warm, alone and on top of stiffness.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/protocol/codec.h"
#include "firmware/safety/torque_gate.h"
#include "tests/firmware/safety/gate_bench.h"

using namespace hoof::firmware;
using control::DriveAction;
using control::Joint;
using control::JointState;
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

/// Feed-forward alone.
control::Wish torque_wish(Mode mode, std::size_t joint, float torque_Nm) {
  control::Wish wish;
  wish.mode = mode;
  wish.joint[joint] = {DriveAction::kCommand, {.torque_Nm = torque_Nm}};
  return wish;
}

/// Feed-forward on top of what stiffness makes of a target away from where the joint is.
control::Wish torque_wish(std::size_t joint, const JointState& state, float stiff_Nm,
                          float torque_Nm) {
  control::Wish wish = torque_wish(Mode::kReady, joint, torque_Nm);
  if (stiff_Nm == 0.0f) return wish;
  const float kp_Nm_rad = joint == 0 ? 250.0f : 15000.0f;
  wish.joint[joint].command.kp_Nm_rad = kp_Nm_rad;
  wish.joint[joint].command.position_rad = state.position_rad + stiff_Nm / kp_Nm_rad;
  return wish;
}

/// Cool; in the fall; warmed through.
constexpr float kHeats[] = {0.0f, 0.95f, 1.02f};

/// Positions near 1 rad (float step 6e-8) times 15000 Nm/rad, and torques of up to 600 Nm (6e-5).
constexpr float kRounding_Nm = 2e-3f;

/// What becomes of a count, reckoned apart from the gate.
struct Expected {
  std::size_t joint;
  bool warm;
  float ceiling_Nm;

  Expected(const safety::TorqueGate& gate, std::size_t which) : joint(which) {
    const double heat = gate.heat_ratio(static_cast<Joint>(joint));
    const double most = kLimits[joint].torque_Nm;
    const double least = safety::kDrives[joint].continuous_torque_Nm;
    warm = heat > 0.9;
    ceiling_Nm =
        static_cast<float>(most + std::clamp((heat - 0.9) / 0.1, 0.0, 1.0) * (least - most));
  }

  void check(const safety::Verdict& verdict, const control::Wish& wish, float stiff_Nm,
             float count_Nm) const {
    const control::JointCommand& c = verdict.joint[joint].command;
    const control::JointCommand& w = wish.joint[joint].command;
    // More than the wire carries is no feed-forward to begin with.
    const float end_Nm = kLimits[joint].feed_forward_Nm;
    const float whole_Nm = stiff_Nm + std::clamp(count_Nm, -end_Nm, end_Nm);
    const float cut_Nm = std::clamp(whole_Nm, -ceiling_Nm, ceiling_Nm);
    REQUIRE(verdict.torque_Nm[joint] == Approx(cut_Nm).margin(kRounding_Nm));
    // The excess is taken from the feed-forward, within what the wire carries; the joint stays as
    // firm, at the same target.
    const float rest_Nm = std::clamp(cut_Nm - stiff_Nm, -end_Nm, end_Nm);
    REQUIRE(c.torque_Nm == Approx(rest_Nm).margin(kRounding_Nm));
    REQUIRE(c.kp_Nm_rad == w.kp_Nm_rad);
    REQUIRE(c.position_rad == w.position_rad);
    check_bits(verdict.limits[joint], whole_Nm, count_Nm);
    check_wire(c.torque_Nm, rest_Nm);
  }

 private:
  void check_bits(safety::LimitBits bits, float whole_Nm, float count_Nm) const {
    const float most_Nm = kLimits[joint].torque_Nm;
    // At the very bound either answer is right.
    const auto beyond = [](float value_Nm, float bound_Nm) {
      return std::abs(value_Nm) > bound_Nm;
    };
    const auto at = [](float value_Nm, float bound_Nm) {
      return std::abs(std::abs(value_Nm) - bound_Nm) <= kRounding_Nm;
    };
    if (at(whole_Nm, most_Nm) || at(whole_Nm, ceiling_Nm)) return;
    safety::LimitBits expected = 0;
    if (beyond(whole_Nm, most_Nm)) expected |= safety::limit::kTorque;
    if (beyond(count_Nm, kLimits[joint].feed_forward_Nm)) expected |= safety::limit::kTorque;
    if (warm && beyond(whole_Nm, ceiling_Nm)) expected |= safety::limit::kOverload;
    REQUIRE(bits == expected);
  }

  /// What the drive reads from the wire.
  void check_wire(float torque_Nm, float expected_Nm) const {
    const protocol::Drive drive = protocol::kDrives[joint];
    const float half_step_Nm = 0.5f * protocol::kCommandSignals[joint][4].scale;
    protocol::DriveOrder order;
    const auto frame = protocol::encode_command(drive, {0, 0, 0, 0, torque_Nm});
    REQUIRE(decode_command(drive, frame, order) == protocol::DecodeResult::kOk);
    REQUIRE(std::abs(order.command.torque_Nm - expected_Nm) <=
            half_step_Nm * 1.001f + kRounding_Nm);
  }
};

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

TEST_CASE("Every torque count within the limit passes unchanged; every one beyond is cut to it",
          "[slow]") {
  const auto joints = resting_joints();
  for (std::size_t joint = 0; joint < control::kJointCount; ++joint) {
    for (const float heat : kHeats) {
      safety::TorqueGate warmed({});
      std::int64_t now_ms = 0;
      safety::test::warm_up(warmed, joint, heat, now_ms);
      const Expected expected(warmed, joint);
      for (const float stiff_Nm : {0.0f, 0.4f * expected.ceiling_Nm, -0.4f * expected.ceiling_Nm}) {
        for_every_count(joint, [&](float count_Nm) {
          safety::TorqueGate gate = warmed;
          const auto wish = torque_wish(joint, joints[joint], stiff_Nm, count_Nm);
          // On the way no tick exceeds the limit either.
          bool kept = true;
          for (int tick = 0; tick < kSettlingTicks; ++tick) {
            const safety::Verdict& verdict = gate.check(wish, joints);
            kept = kept && std::abs(verdict.torque_Nm[joint]) <= expected.ceiling_Nm + kRounding_Nm;
          }
          CAPTURE(joint, heat, stiff_Nm, count_Nm);
          REQUIRE(kept);
          expected.check(gate.verdict(), wish, stiff_Nm, count_Nm);
        });
      }
    }
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
