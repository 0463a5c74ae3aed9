// Optional physics at a drive of the foot, against closed forms.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/drive/drive.h"
#include "sim/effects/effect.h"
#include "tests/sim/drive/plain_drive.h"

using namespace hoof::sim;
using namespace hoof::tests;

namespace {

constexpr double kStep_s = 50e-6;

/// As good as no quantisation and no heat either, and a gear that does not ring.
DriveSettings calm_drive() {
  DriveSettings s = plain_drive();
  s.gear_damping_Nm_s_rad = 3.0;
  s.encoder_counts_turn = 1e7;
  s.temperature_limit_C = 1e6;
  return s;
}

std::unique_ptr<JointEffect> effect(const char* name, std::vector<double> values) {
  return find_effect(name)->make_joint(values);
}

/// Of a joint that is held still.
double hold(Drive& drive, int steps, double joint_rad = 0) {
  double torque_Nm = 0;
  for (int i = 0; i < steps; ++i) torque_Nm = drive.step(kStep_s, joint_rad, 0);
  return torque_Nm;
}

constexpr int kSettled = 10000;  // half a second

}  // namespace

TEST_CASE("play: the rotor of a held joint stands half the gap off, on the side it pushes to") {
  const double side = GENERATE(-1.0, 1.0);
  const double gap_rad = GENERATE(0.004, 0.03);
  Drive drive(calm_drive());
  drive.add_physics(effect("backlash", {gap_rad}));
  drive.enable();
  drive.command(torque_command(4 * side));
  CHECK(hold(drive, kSettled) == Approx(4 * side).epsilon(1e-6));
  const double twist_rad = 4.0 / 2000;
  CHECK(drive.rotor_position_rad() == Approx(side * (0.5 * gap_rad + twist_rad)).epsilon(1e-4));
  const double before_rad = drive.reading().position_rad;
  // At a reversal the encoder runs through all of the gap and twice the twist; the joint stands.
  drive.command(torque_command(-4 * side));
  CHECK(hold(drive, kSettled) == Approx(-4 * side).epsilon(1e-6));
  const double way_rad = side * (before_rad - drive.reading().position_rad);
  CHECK(way_rad == Approx(gap_rad + 2 * twist_rad).epsilon(1e-3));
}

TEST_CASE("in the play the rotor alone is moved: no torque at the joint, tau over J at the rotor") {
  Drive drive(calm_drive());
  drive.add_physics(effect("backlash", {0.2}));
  drive.enable();
  drive.command(torque_command(0.5));
  constexpr int kSteps = 400;  // 20 ms: 10 mrad of the 100 to the side
  for (int i = 0; i < kSteps; ++i) REQUIRE(drive.step(kStep_s, 0, 0) == 0.0);
  CHECK(drive.rotor_velocity_rad_s() == Approx(0.5 / 0.01 * kSteps * kStep_s));
}

TEST_CASE("compliance: the held joint's drive deflects by torque over stiffness") {
  const double torque_Nm = GENERATE(-3.0, 5.0);
  Drive drive(calm_drive());
  drive.add_physics(effect("joint_compliance", {50.0}));
  drive.enable();
  drive.command(torque_command(torque_Nm));
  hold(drive, 8 * kSettled);
  CHECK(drive.rotor_position_rad() == Approx(torque_Nm / 50).epsilon(1e-4));
  // A spring that is stiffer than the gear changes nothing.
  Drive stiff(calm_drive()), without(calm_drive());
  stiff.add_physics(effect("joint_compliance", {5000.0}));
  for (Drive* d : {&stiff, &without}) {
    d->enable();
    d->command(torque_command(torque_Nm));
    hold(*d, 100);
  }
  CHECK(stiff.rotor_position_rad() == without.rotor_position_rad());
}

TEST_CASE("lag: a torque step comes in by its exponential, and the drive tells the step") {
  const double tau_s = 0.01;
  Drive drive(calm_drive());
  drive.add_physics(effect("actuator_lag", {tau_s}));
  drive.enable();
  drive.command(torque_command(0));
  hold(drive, 10);
  drive.command(torque_command(8));
  for (int i = 1; i <= 600; ++i) {
    drive.step(kStep_s, 0, 0);
    // The mean of a step, which is what acts.
    const double start = std::exp(-(i - 1) * kStep_s / tau_s), end = std::exp(-i * kStep_s / tau_s);
    const double mean = 1 - tau_s / kStep_s * (start - end);
    REQUIRE(drive.motor_torque_Nm() == Approx(8 * mean).margin(1e-9));
    REQUIRE(drive.reading().torque_Nm == 8);
  }
}

TEST_CASE("Stribeck friction holds what Coulomb's alone would let go, and falls with speed") {
  DriveSettings settings = calm_drive();
  settings.coulomb_friction_Nm = 1;
  Drive drive(settings);
  drive.add_physics(effect("stribeck_friction", {0.5, 0.2}));
  drive.enable();
  drive.command(torque_command(1.49));
  hold(drive, 1000);
  CHECK(drive.rotor_position_rad() == 0);
  drive.command(torque_command(1.52));
  hold(drive, 1000);
  CHECK(drive.rotor_position_rad() > 0);
  // Rotor and joint go on together: what is left of the torque is Coulomb's and the bump's.
  const double w = GENERATE(0.1, 0.2, 0.6, -0.3);
  Drive moved(settings);
  moved.add_physics(effect("stribeck_friction", {0.5, 0.2}));
  double q = 0, torque_Nm = 0;
  for (int i = 0; i < kSettled; ++i, q += w * kStep_s) torque_Nm = moved.step(kStep_s, q, w);
  const double friction_Nm = 1 + 0.5 * std::exp(-w * w / 0.04);
  CHECK(torque_Nm == Approx(-std::copysign(friction_Nm, w)).epsilon(1e-3));
}

TEST_CASE("friction by load: a joint at an even speed takes coefficient times both torques more") {
  DriveSettings settings = calm_drive();
  settings.coulomb_friction_Nm = 0.5;
  Drive drive(settings);
  const double c = 0.1;
  drive.add_physics(effect("load_dependent_friction", {c}));
  drive.enable();
  const double motor_Nm = GENERATE(-6.0, 6.0);
  drive.command(torque_command(motor_Nm));
  double q = 0, torque_Nm = 0;
  for (int i = 0; i < kSettled; ++i, q += kStep_s) torque_Nm = drive.step(kStep_s, q, 1.0);
  // gear = motor - F, F = 0.5 + c |motor + gear| at a speed above zero.
  const double gear_Nm =
      motor_Nm > 0 ? ((1 - c) * motor_Nm - 0.5) / (1 + c) : ((1 + c) * motor_Nm - 0.5) / (1 - c);
  CHECK(torque_Nm == Approx(gear_Nm).epsilon(1e-6));
}

TEST_CASE("a goal counts from the first step that begins its delay later, and none is lost") {
  const int delay_steps = GENERATE(1, 20, 73);
  DriveSettings settings = calm_drive();
  Drive drive(settings);
  drive.add_physics(effect("transport_delay", {delay_steps * kStep_s}));
  drive.enable();
  for (int i = 0; i < 400; ++i) {
    if (i % 20 == 0) drive.command(torque_command(1 + i / 20));
    drive.step(kStep_s, 0, 0);
    const int goal = i - delay_steps >= 0 ? 1 + (i - delay_steps) / 20 : 0;
    REQUIRE(drive.reading().torque_Nm == std::min(goal, 20));
  }
  // A drive that is switched off and on again does not obey what was on its way.
  drive.disable();
  drive.enable();
  hold(drive, delay_steps + 5);
  CHECK(drive.reading().torque_Nm == 0);
}

TEST_CASE("goals that are lost leave the last one in force, in the share that was asked for") {
  Drive drive(calm_drive());
  drive.add_physics(effect("frame_loss", {0.05, 4.0}));
  drive.enable();
  int lost = 0;
  double last_Nm = 0;
  constexpr int kGoals = 20000;
  for (int i = 1; i <= kGoals; ++i) {
    const double goal_Nm = 1e-4 * i;
    drive.command(torque_command(goal_Nm));
    drive.step(kStep_s, 0, 0);
    const double now_Nm = drive.reading().torque_Nm;
    if (now_Nm != goal_Nm) {
      ++lost;
      REQUIRE(now_Nm == last_Nm);
    }
    last_Nm = now_Nm;
  }
  // Bursts of 4 in the mean, 1/0.05 goals between them.
  CHECK(double(lost) / kGoals == Approx(4.0 / (20 + 4)).epsilon(0.1));
}

TEST_CASE("an eccentric encoder reads its sine, and its zero is where it was made") {
  DriveSettings settings = calm_drive();
  settings.absolute_position = GENERATE(false, true);
  const double phase = 0.7, q = 0.4;
  Drive drive(settings);
  drive.add_physics(effect("encoder_eccentricity", {0.05, phase}));
  drive.step(kStep_s, q, 0);  // the gear draws the rotor after the joint
  for (int i = 0; i < kSettled; ++i) drive.step(kStep_s, q, 0);
  const double zero = settings.absolute_position ? 0 : 0.05 * std::sin(phase);
  CHECK(drive.reading().position_rad == Approx(q + 0.05 * std::sin(q + phase) - zero).margin(1e-5));
}

TEST_CASE("torques on the link reach the joint, not the rotor") {
  Drive drive(calm_drive());
  drive.add_physics(effect("parasitic_spring", {4.0, 0.1}));
  const double q = GENERATE(-0.3, 0.1, 0.5);
  Drive without(calm_drive());
  CHECK(drive.step(kStep_s, q, 0) - without.step(kStep_s, q, 0) == Approx(-4 * (q - 0.1)));
  CHECK(drive.rotor_velocity_rad_s() == without.rotor_velocity_rad_s());
}

TEST_CASE("effects of no size give the bytes of none, whatever is done") {
  DriveSettings settings = calm_drive();
  settings.coulomb_friction_Nm = 0.3;
  settings.viscous_friction_Nm_s_rad = 0.02;
  settings.encoder_counts_turn = 16384;
  Drive with(settings), without(settings);
  with.add_physics(effect("backlash", {0}));
  with.add_physics(effect("stribeck_friction", {0, 0.1}));
  with.add_physics(effect("load_dependent_friction", {0}));
  with.add_physics(effect("directional_friction", {0}));
  with.add_physics(effect("cogging_torque", {0, 6, 1}));
  with.add_physics(effect("transport_delay", {0}));
  with.add_physics(effect("frame_loss", {0, 3}));
  with.add_physics(effect("encoder_eccentricity", {0, 1}));
  with.add_physics(effect("parasitic_spring", {0, 0.2}));
  with.add_physics(effect("torque_ceiling", {1e3}));
  with.enable();
  without.enable();
  std::mt19937_64 random(7);
  double q = 0, w = 0;
  for (int i = 0; i < 20000; ++i) {
    if (i % 20 == 0) {
      DriveCommand c;
      c.position_rad = std::sin(1e-3 * i);
      c.kp_Nm_rad = 30 + double(random() % 50);
      c.kd_Nm_s_rad = 0.5;
      c.torque_Nm = double(random() % 9) - 4;
      with.command(c);
      without.command(c);
    }
    const double torque_Nm = without.step(kStep_s, q, w);
    REQUIRE(with.step(kStep_s, q, w) == torque_Nm);
    REQUIRE(with.reading().position_rad == without.reading().position_rad);
    REQUIRE(with.reading().torque_Nm == without.reading().torque_Nm);
    w += kStep_s * torque_Nm / 0.02;
    q += kStep_s * w;
  }
  CHECK(with.energy().friction_J == without.energy().friction_J);
}

TEST_CASE("play and friction keep the books: energy in is energy stored, lost and given") {
  DriveSettings settings = calm_drive();
  settings.coulomb_friction_Nm = 0.4;
  Drive drive(settings);
  drive.add_physics(effect("backlash", {0.01}));
  drive.add_physics(effect("stribeck_friction", {0.3, 0.5}));
  drive.enable();
  double q = 0, w = 0;
  for (int i = 0; i < 40000; ++i) {
    if (i % 20 == 0) drive.command(torque_command(5 * std::sin(5e-4 * i)));
    const double torque_Nm = drive.step(kStep_s, q, w);
    w += kStep_s * torque_Nm / 0.05;
    q += kStep_s * w;
  }
  const DriveEnergy e = drive.energy();
  const double out_J = e.kinetic_J + e.spring_J + e.friction_J + e.gear_damping_J + e.joint_J;
  REQUIRE(e.motor_J > 1);
  CHECK(out_J == Approx(e.motor_J).epsilon(0.01));
}

TEST_CASE("what acts on the supply is refused: a drive of the foot has none") {
  Drive drive(calm_drive());
  CHECK_THROWS_WITH(drive.add_physics(effect("supply_sag", {1.0})),
                    Catch::Contains("no supply voltage"));
}
