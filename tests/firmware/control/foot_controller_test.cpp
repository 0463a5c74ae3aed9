#include "firmware/control/foot_controller.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/firmware/control/controller_bench.h"

using namespace hoof::firmware::control;
using test::bring_to;
using Bench = test::ControllerBench;

namespace {

// Friction may keep the toes away from their angle by 0.48 Nm / 250 Nm/rad.
constexpr double kFriction_rad = 2e-3;

constexpr Mode kAllModes[] = {Mode::kOff,        Mode::kHoming,       Mode::kReady, Mode::kRunning,
                              Mode::kDampedStop, Mode::kEmergencyOff, Mode::kFault};

}  // namespace

TEST_CASE("From off by way of homing to ready: zero found, toes open, leg at its start") {
  Bench bench;
  bench.tick();
  CHECK(bench.all(DriveAction::kExit));
  REQUIRE(bench.controller.order_ready(0.5f) == Acceptance::kAccepted);
  CHECK(bench.controller.mode() == Mode::kHoming);
  bench.tick();
  CHECK(bench.all(DriveAction::kEnter));
  REQUIRE(bench.run_until(Mode::kReady) > 0);
  CHECK(bench.controller.homed());
  CHECK(bench.toe_zero_rad == Approx(1.5).margin(1e-3));
  bench.run(3000);
  CHECK(bench.states()[0].position_rad == Approx(0.5f).margin(kFriction_rad));
  CHECK(bench.controller.leg().on_path());
  CHECK(bench.controller.mode() == Mode::kReady);
}

TEST_CASE("Toe stays soft while it seeks its stop, leg holds meanwhile") {
  Bench bench;
  bench.controller.order_ready(0.5f);
  while (bench.controller.mode() != Mode::kReady) {
    bench.tick();
    const Wish& wish = bench.controller.wish();
    if (wish.mode != Mode::kHoming || wish.joint[0].action != DriveAction::kCommand) continue;
    REQUIRE(wish.joint[0].command.kp_Nm_rad == 0.0f);
    REQUIRE(wish.joint[1].command.position_rad == Approx(0.5f));
  }
}

TEST_CASE("Run goes through ready, starts the gait at the path's top and follows the ellipse") {
  Bench bench;
  bring_to(bench, Mode::kRunning);
  bench.run(4000);
  CHECK(bench.controller.mode() == Mode::kRunning);
  CHECK(bench.controller.leg().path().rate_Hz() == 1.0f);
  const PlaneVector foot = bench.controller.leg().kinematics().foot_m(
      {float(bench.plants[1].q_rad), float(bench.plants[2].q_rad)});
  const double x = foot.x / 0.10, z = (foot.z + 0.495) / 0.04;
  CHECK(std::sqrt(x * x + z * z) == Approx(1.0).margin(0.1));  // plain joints, not the leg modelled
}

TEST_CASE("Frequency and angle may be changed while running; ready stops the gait") {
  Bench bench;
  bring_to(bench, Mode::kRunning);
  REQUIRE(bench.controller.order_run(0.1f, 0.45f) == Acceptance::kAccepted);
  bench.run(3000);
  CHECK(bench.controller.leg().path().rate_Hz() == 0.45f);
  CHECK(bench.states()[0].position_rad == Approx(0.1f).margin(kFriction_rad));
  REQUIRE(bench.controller.order_ready(0.2f) == Acceptance::kAccepted);
  CHECK(bench.controller.mode() == Mode::kRunning);  // until at rest
  REQUIRE(bench.run_until(Mode::kReady, 2000) > 0);
  const float phase = bench.controller.leg().path().phase_cycles();
  bench.run(500);
  CHECK(bench.controller.leg().path().phase_cycles() == phase);
  REQUIRE(bench.controller.order_run(0.2f, 1.0f) == Acceptance::kAccepted);
  CHECK(bench.run_until(Mode::kRunning, 1000) >= 0);
}

TEST_CASE("Stop lets the joints down by damping alone, then exits; zero is kept") {
  Bench bench;
  bring_to(bench, Mode::kRunning);
  bench.plants[1].load_Nm = 60.0;
  bench.run(200);
  REQUIRE(bench.controller.order_stop() == Acceptance::kAccepted);
  bench.tick();
  CHECK(bench.controller.mode() == Mode::kDampedStop);
  for (const JointWish& joint : bench.controller.wish().joint) {
    CHECK(joint.action == DriveAction::kCommand);
    CHECK(joint.command.kp_Nm_rad == 0.0f);
    CHECK(joint.command.torque_Nm == 0.0f);
    CHECK(joint.command.velocity_rad_s == 0.0f);
    CHECK(joint.command.kd_Nm_s_rad > 0.0f);
  }
  bench.run(500);
  CHECK(bench.plants[1].v_rad_s == Approx((60.0 - 4.8) / 200.024).epsilon(0.02));  // load/damping
  const int rest = bench.run_until(Mode::kOff, 3000);
  CHECK(rest == Approx(1500).margin(2));  // still sinking: ends by its longest time of 2 s
  CHECK(bench.all(DriveAction::kExit));
  CHECK(bench.controller.homed());
}

TEST_CASE("At rest a damped stop ends early") {
  Bench bench;
  bring_to(bench, Mode::kReady);
  bench.controller.order_stop();
  const int ticks = bench.run_until(Mode::kOff, 3000);
  CHECK(ticks >= 100);
  CHECK(ticks < 300);
}

TEST_CASE("Orders by mode: who may do what") {
  using A = Acceptance;
  const A ok = A::kAccepted, no = A::kWrongMode;
  struct Row {
    Mode mode;
    A ready, run, stop, reset;
  };
  const Row rows[] = {
      {Mode::kOff, ok, ok, ok, ok},        {Mode::kHoming, ok, ok, ok, no},
      {Mode::kReady, ok, ok, ok, no},      {Mode::kRunning, ok, ok, ok, no},
      {Mode::kDampedStop, no, no, ok, no}, {Mode::kEmergencyOff, no, no, no, ok},
      {Mode::kFault, no, no, no, ok},
  };
  for (const Row& row : rows) {
    INFO("mode " << int(row.mode));
    const auto in_mode = [&](auto order) {
      Bench bench;
      bring_to(bench, row.mode);
      const A result = order(bench.controller);
      if (result != A::kAccepted) CHECK(bench.controller.mode() == row.mode);
      return result;
    };
    CHECK(in_mode([](FootController& c) { return c.order_ready(0.1f); }) == row.ready);
    CHECK(in_mode([](FootController& c) { return c.order_run(0.1f, 1.0f); }) == row.run);
    CHECK(in_mode([](FootController& c) { return c.order_stop(); }) == row.stop);
    CHECK(in_mode([](FootController& c) { return c.order_reset(); }) == row.reset);
  }
}

TEST_CASE("Orders out of range are refused on both sides and change nothing") {
  Bench bench;
  FootController& c = bench.controller;
  CHECK(c.order_ready(-0.001f) == Acceptance::kOutOfRange);
  CHECK(c.order_ready(0.96f) == Acceptance::kOutOfRange);  // 55 degrees
  CHECK(c.order_ready(std::nanf("")) == Acceptance::kOutOfRange);
  CHECK(c.order_run(0.1f, 0.0f) == Acceptance::kOutOfRange);
  CHECK(c.order_run(0.1f, -1.0f) == Acceptance::kOutOfRange);
  CHECK(c.order_run(0.1f, 2.1f) == Acceptance::kOutOfRange);
  CHECK(c.order_run(0.1f, std::nanf("")) == Acceptance::kOutOfRange);
  CHECK(c.mode() == Mode::kOff);
  CHECK(c.order_ready(0.6981f) == Acceptance::kAccepted);  // 40 degrees as the wire carries it
}

TEST_CASE("A fault in any moving mode begins the damped stop and ends in fault, latched") {
  for (const Mode mode : {Mode::kHoming, Mode::kReady, Mode::kRunning}) {
    Bench bench;
    bring_to(bench, mode);
    bench.controller.trip(fault::kSyncLost);
    CHECK(bench.controller.mode() == Mode::kDampedStop);
    REQUIRE(bench.run_until(Mode::kFault, 3000) > 0);
    CHECK(bench.controller.faults() == fault::kSyncLost);
    CHECK(bench.all(DriveAction::kExit));
    CHECK(bench.controller.order_ready(0.1f) == Acceptance::kWrongMode);
    CHECK(bench.controller.order_reset() == Acceptance::kAccepted);
    CHECK(bench.controller.mode() == Mode::kOff);
    CHECK(bench.controller.faults() == 0);
  }
}

TEST_CASE("An emergency stop takes the torque away from any mode, at once, until the reset") {
  for (const Mode mode : kAllModes) {
    Bench bench;
    bring_to(bench, mode);
    bench.controller.emergency_stop();
    CHECK(bench.all(DriveAction::kExit));
    CHECK(bench.controller.mode() == Mode::kEmergencyOff);
    bench.run(100);
    CHECK(bench.all(DriveAction::kExit));
    bench.controller.trip(fault::kDriveLost);
    CHECK(bench.controller.mode() == Mode::kEmergencyOff);
    CHECK(bench.controller.order_reset() == Acceptance::kAccepted);
    CHECK(bench.controller.mode() == Mode::kOff);
  }
}

TEST_CASE("A fault that may have cost the zero asks for homing anew; others do not") {
  struct Case {
    FaultBits bits;
    bool homed;
  };
  for (const Case& c : {Case{fault::kDriveLost, false}, Case{fault::kDriveError, false},
                        Case{fault::kImplausibleReply, false}, Case{fault::kSyncLost, true},
                        Case{fault::kToeJammed, true}}) {
    Bench bench;
    bring_to(bench, Mode::kReady);
    bench.controller.trip(c.bits);
    CHECK(bench.controller.homed() == c.homed);
  }
}

TEST_CASE("Homing that finds no stop, a jammed toe and an unreachable path are faults") {
  Bench no_stop;
  no_stop.plants[0].stop_rad = -1e9;
  no_stop.controller.order_ready(0.1f);
  REQUIRE(no_stop.run_until(Mode::kFault) > 0);
  CHECK(no_stop.controller.faults() == fault::kHomingFailed);

  Bench jam;
  bring_to(jam, Mode::kReady);
  jam.plants[0].stop_rad = jam.plants[0].q_rad;  // cannot close any more
  jam.controller.order_ready(0.0f);
  REQUIRE(jam.run_until(Mode::kFault) > 0);
  CHECK(jam.controller.faults() == fault::kToeJammed);

  Settings settings;
  settings.path.semi_x_m = 0.5f;
  Bench far({}, settings);
  far.controller.order_run(0.1f, 1.0f);
  REQUIRE(far.run_until(Mode::kFault) > 0);
  CHECK(far.controller.faults() == fault::kPathUnreachable);
}

TEST_CASE("A rig without a leg homes, opens and refuses to run; one without toes only walks") {
  Bench rig({.toe = true, .leg = false});
  CHECK(rig.controller.order_run(0.1f, 1.0f) == Acceptance::kNoLeg);
  REQUIRE(rig.controller.order_ready(0.5f) == Acceptance::kAccepted);
  REQUIRE(rig.run_until(Mode::kReady) > 0);
  rig.run(1000);
  CHECK(rig.states()[0].position_rad == Approx(0.5f).margin(kFriction_rad));
  CHECK(rig.controller.wish().joint[1].action == DriveAction::kExit);
  CHECK_FALSE(rig.controller.ground().valid);

  Bench stilt({.toe = false, .leg = true});
  REQUIRE(stilt.controller.order_run(0.0f, 1.0f) == Acceptance::kAccepted);
  REQUIRE(stilt.run_until(Mode::kRunning) > 0);
  CHECK(stilt.controller.wish().joint[0].action == DriveAction::kExit);
}

TEST_CASE("What was felt before the drives were off is forgotten") {
  Bench bench;
  bring_to(bench, Mode::kReady);
  const LegAngles q{float(bench.plants[1].q_rad), float(bench.plants[2].q_rad)};
  const LegAngles push = bench.controller.leg().kinematics().joint_torque_Nm(q, {0.0f, 300.0f});
  bench.plants[1].load_Nm = push.hip_rad;
  bench.plants[2].load_Nm = push.knee_rad;
  bench.run(200);
  REQUIRE(bench.controller.ground().contact);
  bench.plants[1].load_Nm = bench.plants[2].load_Nm = 0.0;
  bench.controller.emergency_stop();
  bench.controller.order_reset();
  bench.run(100);
  bench.controller.order_ready(0.1f);
  bench.run(7);
  CHECK_FALSE(bench.controller.ground().contact);
}

TEST_CASE("Drives that never answered are not commanded") {
  FootController controller({}, {});
  controller.order_ready(0.1f);
  PerJoint<JointState> silent{};
  for (int i = 0; i < 100; ++i) {
    const Wish& wish = controller.step(silent);
    for (const JointWish& joint : wish.joint) REQUIRE(joint.action == DriveAction::kEnter);
  }
}
