#include "firmware/safety/torque_gate.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/safety/command_limits.h"
#include "tests/firmware/safety/gate_bench.h"

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
using namespace hoof::firmware::safety::test;
using control::DriveAction;
using control::FaultBits;
using control::Joint;
using control::JointCommand;
using control::JointState;
using control::kJointCount;
using control::Mode;
namespace fault = control::fault;

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
  for (JointState& joint : joints) joint.torque_Nm = 1e4f;
  joints[0].torque_Nm = 0.0f;
  for (int ms = 0; ms < 100; ++ms) {
    joints[0].received_ns = ms * kMillisecond_ns;
    CHECK(gate.inspect(joints, Mode::kReady, ms * kMillisecond_ns) == 0);
  }
  const auto& verdict =
      gate.check(wish_for(Mode::kReady, 1, DriveAction::kCommand, {.torque_Nm = 5.0f}), joints);
  CHECK(verdict.joint[1].action == DriveAction::kExit);
  CHECK(verdict.limits[1] == 0);
  CHECK(gate.heat_ratio(Joint::kHip) == 0.0f);
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
      {"jump up", [](JointState& s) { s.reading_rad += 0.09f; }, fault::kImplausibleReply},
      {"jump down", [](JointState& s) { s.reading_rad -= 0.09f; }, fault::kImplausibleReply},
      {"end of range", [](JointState& s) { s.reading_rad = 12.5f; }, fault::kImplausibleReply},
      {"lower end", [](JointState& s) { s.reading_rad = -12.5f; }, fault::kImplausibleReply},
      {"above its travel", [](JointState& s) { s.position_rad = 2.0f; }, fault::kOutsideTravel},
      {"below its travel", [](JointState& s) { s.position_rad = -3.0f; }, fault::kOutsideTravel},
      {"two at once",
       [](JointState& s) {
         s.error = 1;
         s.temperature_C = 130.0f;
       },
       FaultBits(fault::kDriveError | fault::kOverTemperature)},
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

TEST_CASE("Whether SYNC paused or its numbers were missed, a joint has moved meanwhile") {
  struct Case {
    std::uint32_t ticks;
    float moved_rad;
    FaultBits expected;
  };
  // 4 rad/s for 10 ms of the local clock: 40 mrad. The bound of the drift is 20.
  const Case cases[] = {
      {10, 0.040f, 0},                        // numbers missed
      {1, 0.040f, 0},                         // SYNC paused, the joint went on
      {1, 0.004f, 0},                         // a slow plant stood still meanwhile
      {1, 0.0f, 0},                           // 4 too few: not yet
      {10, 0.0f, fault::kImplausibleReply},   // 40 too few by either time
      {1, 0.065f, fault::kImplausibleReply},  // 25 too many by either time
      {1, -0.017f, fault::kImplausibleReply},
  };
  for (const Case& c : cases) {
    for (const float sign : {1.0f, -1.0f}) {
      INFO("ticks " << c.ticks << " moved " << sign * c.moved_rad);
      Watched w;
      w.joints[1].velocity_rad_s = sign * 4.0f;
      w.place(1, sign * 0.002f);
      REQUIRE(w.next() == 0);
      w.now_ms += 10;
      w.place(1, sign * (0.002f + c.moved_rad));
      for (JointState& joint : w.joints) joint.received_ns = w.now_ms * kMillisecond_ns;
      CHECK(w.gate.inspect(w.joints, Mode::kReady, w.now_ms * kMillisecond_ns, c.ticks) ==
            c.expected);
    }
  }
}

TEST_CASE("A drive that does not follow what passed the gate is a fault; the wish does not count") {
  Watched w;
  control::Wish wish;
  wish.mode = Mode::kReady;
  wish.joint[1] = {DriveAction::kCommand, {.torque_Nm = 90.0f}};
  FaultBits found = 0;
  int ticks = 0;
  while (found == 0 && ticks < 1000) {
    w.gate.check(wish, w.joints);
    found = w.next();
    ++ticks;
  }
  CHECK(found == fault::kNotFollowing);
  CHECK(ticks == kNotFollowingTicks);

  Watched refused;
  wish.mode = Mode::kOff;  // exit frames go instead
  for (int i = 0; i < 200; ++i) {
    refused.gate.check(wish, refused.joints);
    REQUIRE(refused.next() == 0);
  }
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
  CHECK(verdict.limits[1] == limit::kLatched);
  CHECK(w.gate.latched());
  CHECK(verdict.joint[1].command.torque_Nm == 0.0f);
  CHECK(verdict.joint[1].command.kd_Nm_s_rad == kLimits[1].stop_kd_Nm_s_rad);
  CHECK(w.gate.check(wish_for(Mode::kReady, 1, DriveAction::kExit), w.joints).faults == 0);
  CHECK(w.gate.latched());
}

TEST_CASE("Damping beyond the ceiling becomes less damping, never a torque of its own") {
  for (const float speed_rad_s : {-19.0f, -1.5f, 1.5f, 19.0f}) {
    CAPTURE(speed_rad_s);
    Watched w;
    w.joints[1].velocity_rad_s = speed_rad_s;
    const JointCommand damping{.kd_Nm_s_rad = kLimits[1].stop_kd_Nm_s_rad};
    const auto& verdict =
        w.gate.check(wish_for(Mode::kDampedStop, 1, DriveAction::kCommand, damping), w.joints);
    const JointCommand& passed = verdict.joint[1].command;
    // Where the reply tells a wrong speed and the joint stands, nothing pushes.
    CHECK(is_pure_damping(passed));
    const float torque_Nm = passed.kd_Nm_s_rad * std::abs(speed_rad_s);
    // Rounding of a product.
    CHECK(torque_Nm <= kLimits[1].torque_Nm * (1.0f + 1e-6f));
    const bool beyond = 200.0f * std::abs(speed_rad_s) > kLimits[1].torque_Nm;
    CHECK((verdict.limits[1] == limit::kTorque) == beyond);
    if (beyond) CHECK(torque_Nm == Approx(kLimits[1].torque_Nm).epsilon(1e-5));
  }
}

TEST_CASE("In every field a number that is none becomes damping") {
  for (int field = 0; field < 5; ++field) {
    Watched w;
    JointCommand c{.kp_Nm_rad = 1.0f};
    float* const fields[] = {&c.position_rad, &c.velocity_rad_s, &c.kp_Nm_rad, &c.kd_Nm_s_rad,
                             &c.torque_Nm};
    *fields[field] = INFINITY;
    const auto& verdict =
        w.gate.check(wish_for(Mode::kRunning, 1, DriveAction::kCommand, c), w.joints);
    CHECK(verdict.faults == fault::kInvalidWish);
    CHECK(is_pure_damping(verdict.joint[1].command));
  }
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

TEST_CASE("The e-stop line stops while pressed, and no reset passes before it is let go") {
  Watched w;
  const auto stiff = wish_for(Mode::kReady, 0, DriveAction::kCommand, {.torque_Nm = 1.0f});
  w.gate.emergency_line(false);
  CHECK_FALSE(w.gate.emergency_pressed());
  CHECK_FALSE(w.gate.latched());
  CHECK(w.gate.check(stiff, w.joints).limits[0] == 0);

  w.gate.emergency_line(true);
  CHECK(w.gate.emergency_pressed());
  CHECK(w.gate.latched());
  CHECK(w.gate.check(stiff, w.joints).joint[0].action == DriveAction::kExit);
  CHECK_FALSE(w.gate.reset());
  CHECK(w.gate.latched());
  CHECK(w.gate.check(stiff, w.joints).joint[0].action == DriveAction::kExit);

  w.gate.emergency_line(false);  // let go: nothing is lifted by that
  CHECK_FALSE(w.gate.emergency_pressed());
  CHECK(w.gate.latched());
  CHECK(w.gate.check(stiff, w.joints).limits[0] == limit::kLatched);
  CHECK(w.gate.reset());
  CHECK_FALSE(w.gate.latched());
  CHECK(w.gate.check(stiff, w.joints).limits[0] == 0);
}

TEST_CASE("What pushes in place of a refused wish is nothing: the next torque starts from zero") {
  for (const Mode mode : {Mode::kOff, Mode::kReady}) {
    Watched w;
    control::Wish wish = wish_for(Mode::kReady, 1, DriveAction::kCommand, {.torque_Nm = 90.0f});
    CHECK(w.gate.check(wish, w.joints).torque_Nm[1] == 90.0f);
    wish.joint[1].action = mode == Mode::kOff ? DriveAction::kCommand : DriveAction::kExit;
    wish.mode = mode;
    CHECK(w.gate.check(wish, w.joints).torque_Nm[1] == 0.0f);
    wish = wish_for(Mode::kReady, 1, DriveAction::kCommand, {.torque_Nm = 190.0f});
    const Verdict& verdict = w.gate.check(wish, w.joints);
    CHECK(verdict.torque_Nm[1] == Approx(100.0f));  // the rate is 1e5 * 1e-3f
    CHECK(verdict.limits[1] == limit::kTorqueRate);
  }
}

TEST_CASE("The limits of all joints together are what each has, and pass with the tick") {
  Watched w;
  control::Wish wish;
  wish.mode = Mode::kReady;
  wish.joint[0] = {DriveAction::kCommand, {.kp_Nm_rad = 1000.0f}};
  wish.joint[1] = {DriveAction::kCommand, {.velocity_rad_s = 9.0f}};
  wish.joint[2] = {DriveAction::kEnter, {}};
  const Verdict& verdict = w.gate.check(wish, w.joints);
  CHECK(verdict.limits[0] == limit::kGain);
  CHECK(verdict.limits[1] == limit::kVelocity);
  CHECK(verdict.limits[2] == limit::kRefused);
  CHECK(verdict.active_limits() == (limit::kGain | limit::kVelocity | limit::kRefused));
  wish = {};
  wish.mode = Mode::kReady;
  CHECK(w.gate.check(wish, w.joints).active_limits() == 0);
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
