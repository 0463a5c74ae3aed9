#include "firmware/safety/torque_gate.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
using control::DriveAction;
using control::FaultBits;
using control::Joint;
using control::JointCommand;
using control::JointState;
using control::kJointCount;
using control::Mode;
namespace fault = control::fault;

namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// A gate that has watched healthy replies for a while; time in milliseconds.
struct Watched {
  TorqueGate gate{control::JointPresence{}};
  control::PerJoint<JointState> joints{};
  std::int64_t now_ms = 0;

  Watched() {
    for (JointState& joint : joints) joint.received = joint.referenced = true;
    joints[2].position_rad = -1.0f;
    for (int i = 0; i < 5; ++i) REQUIRE(next() == 0);
  }

  /// One millisecond on; replies of all joints but `silent` come.
  FaultBits next(int silent = -1) {
    ++now_ms;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (static_cast<int>(i) != silent) joints[i].received_ns = now_ms * kMillisecond_ns;
    }
    return gate.inspect(joints, Mode::kReady, now_ms * kMillisecond_ns);
  }
};

control::Wish wish_for(Mode mode, std::size_t joint, DriveAction action, JointCommand c = {}) {
  control::Wish wish;
  wish.mode = mode;
  wish.joint[joint] = {action, c};
  return wish;
}

}  // namespace

TEST_CASE("A drive silent for 20 ms is passed, for 21 ms it is lost; each joint for itself") {
  for (int joint = 0; joint < 3; ++joint) {
    Watched w;
    for (int i = 0; i < 20; ++i) REQUIRE(w.next(joint) == 0);
    CHECK_FALSE(w.gate.latched());
    CHECK(w.next(joint) == fault::kDriveLost);
    CHECK(w.gate.latched());
    // Its return does not lift the latch.
    CHECK(w.next() == 0);
    CHECK(w.gate.latched());
    w.gate.reset();
    CHECK_FALSE(w.gate.latched());
  }
}

TEST_CASE("A drive that never answers is lost 20 ms after the start of watching") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  FaultBits found = 0;
  int ms = 0;
  while (found == 0 && ms < 100) {
    found = gate.inspect(joints, Mode::kHoming, (1000 + ms++) * kMillisecond_ns);
  }
  CHECK(found == fault::kDriveLost);
  CHECK(ms == 22);  // 0 ... 20 ms pass, 21 ms is too long
}

TEST_CASE("A reply from before the start of watching does not count, neither for nor against") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  for (JointState& joint : joints) {
    joint.received = true;
    joint.received_ns = 5 * kMillisecond_ns;
    joint.error = 1;
  }
  CHECK(gate.inspect(joints, Mode::kOff, 900 * kMillisecond_ns) == 0);
  CHECK(gate.inspect(joints, Mode::kHoming, 1000 * kMillisecond_ns) == 0);
  CHECK(gate.inspect(joints, Mode::kHoming, 1020 * kMillisecond_ns) == 0);
  CHECK(gate.inspect(joints, Mode::kHoming, 1021 * kMillisecond_ns) == fault::kDriveLost);
}

TEST_CASE("Nothing is expected of drives while the mode does not use them") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  for (const Mode mode : {Mode::kOff, Mode::kEmergencyOff, Mode::kFault}) {
    CHECK(gate.inspect(joints, mode, 0) == 0);
    CHECK(gate.inspect(joints, mode, 1'000'000'000'000) == 0);
  }
}

TEST_CASE("Drives are watched in every mode that uses them") {
  for (const Mode mode : {Mode::kHoming, Mode::kReady, Mode::kRunning, Mode::kDampedStop}) {
    INFO("mode " << int(mode));
    TorqueGate gate({});
    control::PerJoint<JointState> joints{};
    CHECK(gate.inspect(joints, mode, 0) == 0);
    CHECK(gate.inspect(joints, mode, 21 * kMillisecond_ns) == fault::kDriveLost);
  }
}

TEST_CASE("Joints that the rig does not have are neither watched nor commanded") {
  TorqueGate gate({.toe = true, .leg = false});
  control::PerJoint<JointState> joints{};
  joints[0].received = true;
  for (int ms = 0; ms < 100; ++ms) {
    joints[0].received_ns = ms * kMillisecond_ns;
    CHECK(gate.inspect(joints, Mode::kReady, ms * kMillisecond_ns) == 0);
  }
  const auto& verdict =
      gate.check(wish_for(Mode::kReady, 1, DriveAction::kCommand, {.torque_Nm = 5.0f}), joints);
  CHECK(verdict.joint[1].action == DriveAction::kExit);
}

TEST_CASE("Every kind of bad reply latches the gate and is named") {
  struct Case {
    const char* name;
    void (*spoil)(JointState&);
    FaultBits expected;
  };
  const Case cases[] = {
      {"drive error", [](JointState& s) { s.error = 3; }, fault::kDriveError},
      {"unknown drive error", [](JointState& s) { s.error = 200; }, fault::kDriveError},
      {"hot", [](JointState& s) { s.temperature_C = 101.0f; }, fault::kOverTemperature},
      {"jump up", [](JointState& s) { s.position_rad += 0.09f; }, fault::kImplausibleReply},
      {"jump down", [](JointState& s) { s.position_rad -= 0.09f; }, fault::kImplausibleReply},
      {"end of range", [](JointState& s) { s.position_rad = 12.5f; },
       FaultBits(fault::kImplausibleReply | fault::kOutsideTravel)},
      {"lower end of range", [](JointState& s) { s.position_rad = -12.5f; },
       FaultBits(fault::kImplausibleReply | fault::kOutsideTravel)},
  };
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const Case& c : cases) {
      INFO(c.name << ", joint " << joint);
      Watched w;
      c.spoil(w.joints[joint]);
      CHECK(w.next() == c.expected);
      CHECK(w.gate.latched());
    }
  }
}

TEST_CASE("Just inside its bounds a reply passes") {
  Watched w;
  w.joints[0].position_rad += 0.044f;  // 45 rad/s for 1 ms
  w.joints[1].position_rad -= 0.019f;  // 20 rad/s for 1 ms
  w.joints[2].temperature_C = 100.0f;
  CHECK(w.next() == 0);
}

TEST_CASE("Beyond its travel a joint is a fault, where its zero is known") {
  for (const bool known : {true, false}) {
    Watched w;
    w.joints[0].referenced = known;
    FaultBits found = 0;
    for (int i = 0; i < 60 && found == 0; ++i) {
      w.joints[0].position_rad += 0.02f;
      found = w.next();
    }
    CHECK(found == (known ? fault::kOutsideTravel : 0));
    if (known) CHECK(w.joints[0].position_rad == Approx(1.06f));  // 1.0 + 0.05, in steps of 0.02
  }
}

TEST_CASE("A moved zero is no jump") {
  Watched w;
  w.joints[0].position_rad += 0.5f;
  w.gate.forget_position(Joint::kToe);
  CHECK(w.next() == 0);
}

TEST_CASE("The allow-list, mode by mode") {
  const JointCommand stiff{.kp_Nm_rad = 1.0f};
  const JointCommand damping{.kd_Nm_s_rad = 1.0f};
  const JointCommand speed{.velocity_rad_s = -0.5f, .kd_Nm_s_rad = 1.0f};
  struct Case {
    Mode mode;
    std::size_t joint;
    DriveAction action;
    JointCommand command;
    bool passes;
  };
  const Case cases[] = {
      {Mode::kHoming, 0, DriveAction::kEnter, {}, true},
      {Mode::kReady, 0, DriveAction::kEnter, {}, false},
      {Mode::kRunning, 1, DriveAction::kEnter, {}, false},
      {Mode::kDampedStop, 1, DriveAction::kEnter, {}, false},
      {Mode::kOff, 1, DriveAction::kEnter, {}, false},
      {Mode::kHoming, 0, DriveAction::kCommand, speed, true},
      {Mode::kHoming, 0, DriveAction::kCommand, stiff, false},
      {Mode::kHoming, 1, DriveAction::kCommand, stiff, true},
      {Mode::kReady, 0, DriveAction::kCommand, stiff, true},
      {Mode::kRunning, 2, DriveAction::kCommand, stiff, true},
      {Mode::kDampedStop, 2, DriveAction::kCommand, damping, true},
      {Mode::kDampedStop, 2, DriveAction::kCommand, stiff, false},
      {Mode::kDampedStop, 2, DriveAction::kCommand, speed, false},
      {Mode::kOff, 0, DriveAction::kCommand, damping, false},
      {Mode::kFault, 0, DriveAction::kCommand, damping, false},
      {Mode::kEmergencyOff, 0, DriveAction::kCommand, damping, false},
      {Mode::kOff, 0, DriveAction::kExit, {}, true},
      {Mode::kRunning, 0, DriveAction::kExit, {}, true},
  };
  for (const Case& c : cases) {
    INFO("mode " << int(c.mode) << " joint " << c.joint << " action " << int(c.action));
    Watched w;
    JointCommand command = c.command;
    command.position_rad = w.joints[c.joint].position_rad;
    const auto& verdict = w.gate.check(wish_for(c.mode, c.joint, c.action, command), w.joints);
    CHECK(verdict.joint[c.joint].action == (c.passes ? c.action : DriveAction::kExit));
    CHECK(verdict.limits[c.joint] == (c.passes ? 0 : limit::kRefused));
    CHECK(w.gate.interventions() == (c.passes ? 0u : 1u));
  }
}

TEST_CASE("A mode that is none allows nothing but exit") {
  const auto none = static_cast<Mode>(7);  // a flipped bit
  Watched w;
  const JointCommand damping{.kd_Nm_s_rad = 1.0f};
  CHECK(w.gate.check(wish_for(none, 1, DriveAction::kCommand, damping), w.joints).limits[1] ==
        limit::kRefused);
  CHECK(w.gate.verdict().joint[1].action == DriveAction::kExit);
  CHECK(w.gate.check(wish_for(none, 1, DriveAction::kExit), w.joints).limits[1] == 0);
}

TEST_CASE("A latched gate lets a wish of pure damping through as it is") {
  Watched w;
  w.gate.latch();
  const auto& verdict = w.gate.check(
      wish_for(Mode::kDampedStop, 1, DriveAction::kCommand, {.kd_Nm_s_rad = 123.0f}), w.joints);
  CHECK(verdict.joint[1].action == DriveAction::kCommand);
  CHECK(verdict.joint[1].command.kd_Nm_s_rad == 123.0f);
  CHECK(verdict.limits[1] == 0);
}

TEST_CASE("A command for a joint never heard of is refused") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  const auto& verdict =
      gate.check(wish_for(Mode::kReady, 0, DriveAction::kCommand, {.torque_Nm = 1.0f}), joints);
  CHECK(verdict.joint[0].action == DriveAction::kExit);
  CHECK(verdict.limits[0] == limit::kRefused);
}

TEST_CASE("A wish that is not a number latches and becomes damping") {
  Watched w;
  const auto& verdict = w.gate.check(
      wish_for(Mode::kReady, 1, DriveAction::kCommand, {.torque_Nm = std::nanf("")}), w.joints);
  CHECK(verdict.faults == fault::kInvalidWish);
  CHECK(w.gate.latched());
  CHECK(verdict.joint[1].command.torque_Nm == 0.0f);
  CHECK(verdict.joint[1].command.kd_Nm_s_rad == kLimits[1].stop_kd_Nm_s_rad);
}

TEST_CASE("After an emergency stop only exit passes, until the reset") {
  Watched w;
  w.gate.emergency_stop();
  for (const Mode mode : {Mode::kReady, Mode::kDampedStop, Mode::kHoming}) {
    for (const DriveAction action : {DriveAction::kCommand, DriveAction::kEnter}) {
      const auto& verdict =
          w.gate.check(wish_for(mode, 0, action, {.kd_Nm_s_rad = 1.0f}), w.joints);
      CHECK(verdict.joint[0].action == DriveAction::kExit);
      CHECK(verdict.limits[0] == limit::kLatched);
    }
  }
  w.gate.reset();
  const auto& verdict =
      w.gate.check(wish_for(Mode::kReady, 0, DriveAction::kCommand, {.torque_Nm = 1.0f}), w.joints);
  CHECK(verdict.joint[0].command.torque_Nm == 1.0f);
}

TEST_CASE("Interventions count each joint and tick once") {
  Watched w;
  control::Wish wish;
  wish.mode = Mode::kReady;
  wish.joint[0] = {DriveAction::kCommand, {.torque_Nm = 1000.0f}};
  wish.joint[1] = {DriveAction::kCommand, {.torque_Nm = 1.0f}};
  wish.joint[2] = {DriveAction::kCommand, {.torque_Nm = -1000.0f}};
  for (int tick = 0; tick < 10; ++tick) w.gate.check(wish, w.joints);
  CHECK(w.gate.interventions() == 20);
}
