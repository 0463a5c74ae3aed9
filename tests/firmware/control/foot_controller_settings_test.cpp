// Settings written while off, calibration, absolute encoders, and a toe that stalls.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/firmware/control/controller_bench.h"

using namespace hoof::firmware::control;
using test::bring_to;
using test::JointPlant;
using Bench = test::ControllerBench;

namespace {

Settings absolute_toe() {
  Settings s;
  s.homing.absolute_encoder = 1.0f;
  return s;
}

Settings uncalibrated_leg() {
  Settings s;
  s.leg.calibrated = 0.0f;
  return s;
}

void stop(Bench& bench) {
  REQUIRE(bench.controller.order_stop() == Acceptance::kAccepted);
  REQUIRE(bench.run_until(Mode::kOff, 3000) >= 0);
}

}  // namespace

TEST_CASE("A toe that lost its torque stalls: a fault, and the zero is kept") {
  Bench bench;
  bring_to(bench, Mode::kReady);
  bench.plants[0].torque_limit_Nm = 0.2;
  REQUIRE(bench.controller.order_ready(0.6f) == Acceptance::kAccepted);
  REQUIRE(bench.run_until(Mode::kFault) > 0);
  CHECK(bench.controller.faults() == fault::kToeStalled);
  CHECK(bench.controller.homed());
}

TEST_CASE("Run waits for the toes, though their move begins some ticks after the order") {
  Bench bench;
  bring_to(bench, Mode::kReady);
  REQUIRE(bench.controller.order_run(0.6f, 1.0f) == Acceptance::kAccepted);
  REQUIRE(bench.run_until(Mode::kRunning) > 100);
  CHECK(bench.controller.toe().set_point_rad() == 0.6f);
}

TEST_CASE("From homing to ready no set point jumps, planning or not") {
  Bench bench;
  bench.controller.order_run(0.5f, 1.0f);
  PerJoint<JointCommand> before{};
  PerJoint<bool> known{};
  for (int i = 0; i < 6000 && bench.controller.mode() != Mode::kRunning; ++i) {
    const float zero_rad = bench.toe_zero_rad;
    bench.tick();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const JointWish& wish = bench.controller.wish().joint[j];
      const bool stiff = wish.action == DriveAction::kCommand && wish.command.kp_Nm_rad > 0.0f;
      const bool same_zero = j != 0 || zero_rad == bench.toe_zero_rad;
      if (stiff && known[j] && same_zero) {
        const float fastest = j == 0 ? 2.0f : 1.0f;
        REQUIRE(std::abs(wish.command.position_rad - before[j].position_rad) <=
                fastest * 1.001f * kTick_s + 1e-6f);
      }
      // The first stiff command is where the joint is.
      if (stiff && !known[j]) {
        REQUIRE(wish.command.position_rad == Approx(bench.states()[j].position_rad).margin(2e-3));
      }
      known[j] = stiff;
      before[j] = wish.command;
    }
  }
  CHECK(bench.controller.mode() == Mode::kRunning);
}

TEST_CASE(
    "Not calibrated: what moves is refused, by leg and by absolute toe, where they are there") {
  using A = Acceptance;
  Settings toe = absolute_toe();
  toe.homing.calibrated = 0.0f;
  Settings seeking;  // a toe that finds its zero at the stop needs none
  seeking.homing.calibrated = 0.0f;
  struct Case {
    Settings settings;
    JointPresence presence;
    A ready, run;
  };
  const Case cases[] = {
      {uncalibrated_leg(), {}, A::kNotCalibrated, A::kNotCalibrated},
      {uncalibrated_leg(), {.toe = true, .leg = false}, A::kAccepted, A::kNoLeg},
      {toe, {}, A::kNotCalibrated, A::kNotCalibrated},
      {toe, {.toe = false, .leg = true}, A::kAccepted, A::kAccepted},
      {seeking, {}, A::kAccepted, A::kAccepted},
      {{}, {}, A::kAccepted, A::kAccepted},
  };
  for (const Case& c : cases) {
    for (const bool run : {false, true}) {
      Bench bench(c.presence, c.settings);
      bench.run(10);
      const A answer =
          run ? bench.controller.order_run(0.1f, 1.0f) : bench.controller.order_ready(0.1f);
      CHECK(answer == (run ? c.run : c.ready));
      if (answer != A::kAccepted) CHECK(bench.controller.mode() == Mode::kOff);
    }
  }
  Bench bench({}, toe);
  bench.run(10);
  CHECK_FALSE(bench.controller.homed());
  CHECK(bench.controller.order_ready(2.0f) == A::kOutOfRange);  // the order's own fault first
  CHECK(bench.controller.order_stop() == A::kAccepted);
  CHECK(bench.controller.order_reset() == A::kAccepted);
}

TEST_CASE("An absolute encoder: homed as soon as the drive answers, and nothing is sought") {
  FootController silent(absolute_toe(), {});
  silent.step({});
  CHECK_FALSE(silent.homed());

  Bench bench({}, absolute_toe());
  bench.plants[0].stop_rad = -1e9;
  bench.plants[0].q_rad = 0.25;
  CHECK_FALSE(bench.controller.homed());
  bench.tick();
  CHECK(bench.controller.homed());
  REQUIRE(bench.controller.order_ready(0.5f) == Acceptance::kAccepted);
  for (int i = 0; i < 2000; ++i) {
    bench.tick();
    REQUIRE_FALSE(bench.controller.new_toe_zero_rad());
    REQUIRE(bench.plants[0].q_rad > 0.249);  // it never closed
  }
  CHECK(bench.controller.mode() == Mode::kReady);
  CHECK(bench.states()[0].position_rad == Approx(0.5f).margin(2e-3));
  // What costs a counting drive its zero does not cost an absolute one.
  bench.controller.trip(fault::kDriveLost);
  REQUIRE(bench.run_until(Mode::kFault) > 0);
  CHECK(bench.controller.homed());
}

TEST_CASE("Settings are taken in mode off and in no other, and are as if there from the start") {
  Settings other;
  other.toe.kp_Nm_rad = 100.0f;
  other.path.semi_x_m = 0.05f;
  other.leg.speed_rad_s = 0.5f;
  other.contact.body_speed_m_s = 0.2f;
  other.stop.longest_s = 1.0f;
  for (const Mode mode : {Mode::kHoming, Mode::kReady, Mode::kRunning, Mode::kDampedStop,
                          Mode::kEmergencyOff, Mode::kFault}) {
    Bench bench, untouched;
    bring_to(bench, mode);
    bring_to(untouched, mode);
    CHECK_FALSE(bench.controller.configure(other, {.toe = true, .leg = false}));
    CHECK(bench.controller.presence().leg);
    for (int i = 0; i < 500; ++i) {
      bench.tick();
      untouched.tick();
      for (std::size_t j = 0; j < kJointCount; ++j) {
        REQUIRE(std::memcmp(&bench.controller.wish().joint[j].command,
                            &untouched.controller.wish().joint[j].command,
                            sizeof(JointCommand)) == 0);
      }
    }
  }

  Bench late, early({}, other);
  bring_to(late, Mode::kRunning);  // a life before
  late.run(700);
  stop(late);
  const PerJoint<JointPlant> plants = late.plants;
  const float zero_rad = late.toe_zero_rad;
  REQUIRE(late.controller.configure(other, {}));
  CHECK(late.controller.homed());
  bring_to(early, Mode::kReady);
  stop(early);
  early.plants = plants;
  early.toe_zero_rad = zero_rad;
  late.controller.order_run(0.4f, 0.8f);
  early.controller.order_run(0.4f, 0.8f);
  for (int i = 0; i < 6000; ++i) {
    late.tick();
    early.tick();
    REQUIRE(late.controller.mode() == early.controller.mode());
    for (std::size_t j = 0; j < kJointCount; ++j) {
      REQUIRE(std::memcmp(&late.controller.wish().joint[j].command,
                          &early.controller.wish().joint[j].command, sizeof(JointCommand)) == 0);
    }
  }
  CHECK(late.controller.mode() == Mode::kRunning);
}

TEST_CASE(
    "New settings keep the toe's zero unless they change how it is found or whether there is a "
    "toe") {
  const auto homed_after = [](auto change) {
    Bench bench;
    bring_to(bench, Mode::kReady);
    stop(bench);
    Settings settings;
    JointPresence presence;
    change(settings, presence);
    REQUIRE(bench.controller.configure(settings, presence));
    return bench.controller.homed();
  };
  CHECK(homed_after([](Settings&, JointPresence&) {}));
  CHECK(homed_after([](Settings& s, JointPresence&) { s.toe.kp_Nm_rad = 1.0f; }));
  CHECK(homed_after([](Settings&, JointPresence& p) { p.leg = false; }));
  CHECK_FALSE(homed_after([](Settings& s, JointPresence&) { s.homing.stop_angle_rad = 0.01f; }));
  CHECK_FALSE(homed_after([](Settings& s, JointPresence&) { s.homing.speed_rad_s = 0.4f; }));
  CHECK_FALSE(homed_after([](Settings& s, JointPresence&) { s.homing.absolute_encoder = 1.0f; }));
  CHECK(homed_after([](Settings&, JointPresence& p) { p.toe = false; }));  // none to be homed

  Bench bench;
  bring_to(bench, Mode::kReady);
  stop(bench);
  REQUIRE(bench.controller.configure({}, {.toe = false, .leg = true}));
  REQUIRE(bench.controller.configure({}, {}));
  CHECK_FALSE(bench.controller.homed());  // a toe that came back
}

TEST_CASE("A joint that new settings take away is neither commanded nor waited for") {
  Bench bench;
  bench.run(5);
  REQUIRE(bench.controller.configure({}, {.toe = true, .leg = false}));
  CHECK(bench.controller.order_run(0.1f, 1.0f) == Acceptance::kNoLeg);
  REQUIRE(bench.controller.order_ready(0.3f) == Acceptance::kAccepted);
  REQUIRE(bench.run_until(Mode::kReady) > 0);
  CHECK(bench.controller.wish().joint[1].action == DriveAction::kExit);
}

TEST_CASE(
    "A leg that swings through the air feels nothing, though its drives hold targets for a tick") {
  FootController c({}, {.toe = false, .leg = true});
  const Settings settings;
  PerJoint<JointState> joints{};
  for (JointState& joint : joints) joint.received = true;
  joints[1].position_rad = 0.562f;
  joints[2].position_rad = -1.42f;
  REQUIRE(c.order_run(0.0f, 1.12f) == Acceptance::kAccepted);
  float worst_N = 0.0f, fastest_rad_s = 0.0f;
  for (int i = 0; i < 6000; ++i) {
    const Wish& wish = c.step(joints);
    // Joints that follow without error; the torque that moves them is the mean of the tick.
    const LegAngles q = c.leg().set_point_rad();
    const LegAngles v{wish.joint[1].command.velocity_rad_s, wish.joint[2].command.velocity_rad_s};
    const LegAngles mean = c.leg().dynamics().torque_Nm(q, v, c.leg().acceleration_rad_s2());
    const float half_tick = 0.5f * kTick_s * settings.leg.kp_Nm_rad;
    joints[1].position_rad = q.hip_rad, joints[2].position_rad = q.knee_rad;
    joints[1].velocity_rad_s = v.hip_rad, joints[2].velocity_rad_s = v.knee_rad;
    joints[1].torque_Nm = mean.hip_rad - half_tick * v.hip_rad;
    joints[2].torque_Nm = mean.knee_rad - half_tick * v.knee_rad;
    if (c.mode() != Mode::kRunning) continue;
    worst_N = std::max({worst_N, std::abs(c.ground().force_N.x), std::abs(c.ground().force_N.z)});
    fastest_rad_s = std::max(fastest_rad_s, std::abs(v.knee_rad));
    REQUIRE_FALSE(c.ground().contact);
  }
  CHECK(fastest_rad_s > 1.5f);
  // A tick between the state and the commanded acceleration: 60 rad/s3 of jerk and 0.4 kg m2.
  CHECK(worst_N < 1.0f);
}
