#include "sim/drive/drive.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/drive/plain_drive.h"

using namespace hoof::sim;
using namespace hoof::tests;

namespace {

constexpr double kStep_s = 50e-6;

/// Steps with the joint held still.
double hold_joint(Drive& drive, double time_s, double joint_rad = 0.0) {
  double torque_Nm = 0.0;
  const int steps = static_cast<int>(std::lround(time_s / kStep_s));
  for (int i = 0; i < steps; ++i) torque_Nm = drive.step(kStep_s, joint_rad, 0.0);
  return torque_Nm;
}

/// A joint of this inertia, moved by the drive (semi-implicit Euler, as the multibody side does).
struct Inertia {
  double inertia_kg_m2;
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;

  void advance(Drive& drive, double time_s, double load_Nm = 0.0) {
    const int steps = static_cast<int>(std::lround(time_s / kStep_s));
    for (int i = 0; i < steps; ++i) {
      const double torque_Nm = drive.step(kStep_s, position_rad, velocity_rad_s) + load_Nm;
      velocity_rad_s += kStep_s * torque_Nm / inertia_kg_m2;
      position_rad += kStep_s * velocity_rad_s;
    }
  }
};

}  // namespace

TEST_CASE("a rotor on a held joint rings at sqrt(k/J) about the static twist") {
  Drive drive(plain_drive());
  drive.enable();
  const double sign = GENERATE(-1.0, 1.0);
  drive.command(torque_command(sign * 4.0));
  // q(t) = tau/k (1 - cos(w t)), w = sqrt(2000 / 0.01) = 447 rad/s; largest after half a period.
  const double w = std::sqrt(2000.0 / 0.01);
  double largest = 0.0;
  double time_of_largest_s = 0.0;
  for (int i = 1; i <= 200; ++i) {
    drive.step(kStep_s, 0.0, 0.0);
    if (sign * drive.rotor_position_rad() > largest) {
      largest = sign * drive.rotor_position_rad();
      time_of_largest_s = i * kStep_s;
    }
  }
  // The integrator is of first order in its sub-step of 5 us: h w / 2 = 0.1 % in amplitude.
  CHECK(largest == Approx(2.0 * 4.0 / 2000.0).epsilon(2e-3));
  CHECK(time_of_largest_s == Approx(std::numbers::pi / w).margin(kStep_s));
}

TEST_CASE("with gear damping the torque on a held joint settles to the command, both signs") {
  DriveSettings settings = plain_drive();
  settings.gear_damping_Nm_s_rad = 4.0;
  Drive drive(settings);
  drive.enable();
  const double torque_Nm = GENERATE(-7.0, 0.0, 7.0);
  drive.command(torque_command(torque_Nm));
  CHECK(hold_joint(drive, 0.2) == Approx(torque_Nm).margin(1e-6));
  CHECK(drive.reading().torque_Nm == torque_Nm);
}

TEST_CASE("position law: a free joint goes to the command as a damped oscillator") {
  // Rotor and joint together: I = 0.03 kg m2 on kp = 30, kd = 2 rad/s: w = 31.6, zeta = 1.05. The
  // gear (2000 Nm/rad) is 67 times stiffer than kp, the joint follows the rotor within 1 %.
  DriveSettings settings = plain_drive();
  settings.gear_damping_Nm_s_rad = 0.5;
  Drive drive(settings);
  Inertia joint{0.02};
  drive.enable();
  const double sign = GENERATE(-1.0, 1.0);
  drive.command({sign * 0.3, 0.0, 30.0, 2.0, 0.0});
  joint.advance(drive, 0.1);
  const double w = std::sqrt(30.0 / 0.03);
  const double zeta = 2.0 / (2.0 * 0.03 * w);
  const double root = std::sqrt(zeta * zeta - 1.0);
  const double s1 = -w * (zeta - root);
  const double s2 = -w * (zeta + root);
  const double expected =
      0.3 * (1.0 + (s2 * std::exp(s1 * 0.1) - s1 * std::exp(s2 * 0.1)) / (s1 - s2));
  // 3 %: the velocity filter (200 Hz) and the gear delay the law by about 1 ms of 100.
  CHECK(sign * joint.position_rad == Approx(expected).epsilon(0.03));
  joint.advance(drive, 1.0);
  CHECK(sign * joint.position_rad == Approx(0.3).margin(1e-4));
}

TEST_CASE("stiction holds below the Coulomb torque and lets go above") {
  DriveSettings settings = plain_drive();
  settings.coulomb_friction_Nm = 0.5;
  settings.gear_damping_Nm_s_rad = 2.0;
  const double sign = GENERATE(-1.0, 1.0);

  Drive stuck(settings);
  stuck.enable();
  stuck.command(torque_command(sign * 0.499));
  Inertia joint{0.02};
  joint.advance(stuck, 1.0);
  CHECK(stuck.rotor_position_rad() == 0.0);  // exactly: no creep at w = 0
  CHECK(joint.position_rad == 0.0);

  Drive sliding(settings);
  sliding.enable();
  sliding.command(torque_command(sign * 0.6));
  Inertia moved{0.02};
  moved.advance(sliding, 0.5);
  // The excess of 0.1 Nm accelerates both inertias: 0.1/0.03 * 0.5 s.
  CHECK(moved.velocity_rad_s == Approx(sign * 0.1 / 0.03 * 0.5).epsilon(1e-3));
}

TEST_CASE("a disabled drive is driven back against friction and rotor alone") {
  DriveSettings settings = plain_drive();
  settings.coulomb_friction_Nm = 0.5;
  settings.gear_damping_Nm_s_rad = 2.0;
  Drive drive(settings);
  drive.command(torque_command(10.0));  // not enabled: without effect
  const double sign = GENERATE(-1.0, 1.0);

  // A sudden load swings the joint on the gear: up to twice the load reaches the rotor.
  Inertia held{0.02};
  held.advance(drive, 0.5, sign * 0.24);
  CHECK(drive.rotor_position_rad() == 0.0);

  Inertia pushed{0.02};
  Drive second(settings);
  pushed.advance(second, 0.5, sign * 0.8);
  // 1 %: the first swing on the gear moves the rotor a little before the steady slide.
  CHECK(pushed.velocity_rad_s == Approx(sign * 0.3 / 0.03 * 0.5).epsilon(1e-2));
}

TEST_CASE("viscous friction ends in a speed of torque over coefficient") {
  DriveSettings settings = plain_drive();
  settings.viscous_friction_Nm_s_rad = 0.2;
  settings.gear_damping_Nm_s_rad = 1.0;
  Drive drive(settings);
  drive.enable();
  drive.command(torque_command(-1.0));
  Inertia joint{0.02};
  joint.advance(drive, 2.0);  // 13 time constants of 0.03/0.2 s
  CHECK(joint.velocity_rad_s == Approx(-5.0).epsilon(1e-4));
}

TEST_CASE("torque is clipped to the limit, and to the speed-torque line when driving") {
  DriveSettings settings = plain_drive();
  settings.stall_torque_Nm = 40.0;
  settings.no_load_speed_rad_s = 10.0;
  settings.gear_damping_Nm_s_rad = 1.0;
  const double sign = GENERATE(-1.0, 1.0);

  Drive at_rest(settings);
  at_rest.enable();
  at_rest.command(torque_command(sign * 1000.0));
  at_rest.step(kStep_s, 0.0, 0.0);
  CHECK(at_rest.motor_torque_Nm() == sign * 20.0);

  // Line: 40 (1 - w/10). At 7.5 rad/s 10 Nm are left; no torque is left at the no-load speed.
  Drive free_running(settings);
  free_running.enable();
  free_running.command(torque_command(sign * 1000.0));
  Inertia joint{0.02};
  joint.advance(free_running, 1.0);
  CHECK(joint.velocity_rad_s == Approx(sign * 10.0).epsilon(1e-3));

  // Braking from that speed has the whole limit.
  free_running.command(torque_command(-sign * 1000.0));
  joint.advance(free_running, kStep_s);
  CHECK(free_running.motor_torque_Nm() == -sign * 20.0);
}

TEST_CASE("the encoder counts on the motor shaft and says the nearest count") {
  DriveSettings settings = plain_drive();
  settings.encoder_counts_turn = 100.0;
  const double count_rad = 2.0 * std::numbers::pi / 1000.0;
  for (const double counts : {-3.4, -0.6, 0.4, 2.6}) {
    // An absolute encoder knows where it woke up; a relaxed gear has the rotor there as well.
    Drive drive(settings, counts * count_rad);
    drive.step(kStep_s, counts * count_rad, 0.0);
    CHECK(drive.reading().position_rad == Approx(std::round(counts) * count_rad).margin(1e-12));
  }
}

TEST_CASE("a drive without absolute encoder counts from where it woke up; zero() starts anew") {
  DriveSettings settings = plain_drive();
  settings.absolute_position = false;
  Drive drive(settings, 0.7);
  drive.step(kStep_s, 0.7, 0.0);
  CHECK(drive.reading().position_rad == 0.0);

  drive.enable();
  settings.gear_damping_Nm_s_rad = 1.0;
  Drive moved(settings, 0.7);
  moved.enable();
  moved.command(torque_command(2.0));
  hold_joint(moved, 0.3, 0.7);
  const double twist = 2.0 / 2000.0;
  const double count_rad = 2.0 * std::numbers::pi / 163840.0;
  CHECK(moved.reading().position_rad == Approx(twist).margin(count_rad));
  moved.zero();
  moved.step(kStep_s, 0.7, 0.0);
  CHECK(moved.reading().position_rad == Approx(0.0).margin(count_rad));
  CHECK(moved.rotor_position_rad() == Approx(0.7 + twist).margin(1e-6));
}

TEST_CASE("the velocity reading follows a steady turn") {
  DriveSettings settings = plain_drive();
  settings.gear_damping_Nm_s_rad = 1.0;
  Drive drive(settings);
  const double speed = GENERATE(-1.5, 1.5);
  for (int i = 0; i < 4000; ++i) drive.step(kStep_s, speed * i * kStep_s, speed);
  // One count per step is 0.77 rad/s; the filter leaves 6 % of that as ripple.
  CHECK(drive.reading().velocity_rad_s == Approx(speed).margin(0.05));
}

TEST_CASE("torque ends 20 ms after the last command, to the step") {
  DriveSettings settings = plain_drive();
  settings.command_timeout_s = 0.020;
  Drive drive(settings);
  drive.enable();
  drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 0.0);  // enabled, but no command yet
  drive.command(torque_command(1.0));
  for (int i = 0; i < 399; ++i) drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 1.0);
  for (int i = 0; i < 2; ++i) drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 0.0);
  drive.command(torque_command(1.0));
  drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 1.0);
  drive.disable();
  drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 0.0);
  drive.enable();  // an old command does not come back to life
  drive.step(kStep_s, 0.0, 0.0);
  CHECK(drive.motor_torque_Nm() == 0.0);
}

TEST_CASE("the winding warms up by copper loss and stops the drive at its limit") {
  DriveSettings settings = plain_drive();
  settings.gear_damping_Nm_s_rad = 1.0;
  settings.copper_loss_W_Nm2 = 0.2;
  settings.heat_capacity_J_K = 1.0;
  Drive drive(settings);
  drive.enable();
  drive.command(torque_command(10.0));
  hold_joint(drive, 1.5);
  // T - 25 = 3 K/W * 20 W * (1 - exp(-t / (3 K/W * 1 J/K))).
  CHECK(drive.reading().temperature_C ==
        Approx(25.0 + 60.0 * (1.0 - std::exp(-0.5))).epsilon(1e-3));
  drive.command(torque_command(20.0));  // 80 W: final temperature 265 C
  hold_joint(drive, 3.0);
  CHECK(drive.reading().error == DriveError::kOverTemperature);
  CHECK(drive.motor_torque_Nm() == 0.0);
  drive.enable();
  CHECK(drive.reading().error == DriveError::kNone);
}

TEST_CASE("rotor and joint ring against each other for a second without losing or making energy") {
  Drive drive(plain_drive());
  Inertia joint{0.02};
  joint.velocity_rad_s = GENERATE(-1.0, 1.0);
  const double start_J = 0.5 * 0.02;
  joint.advance(drive, 1.0);  // 87 periods of sqrt(k (1/J + 1/I)) = 548 rad/s
  const DriveEnergy e = drive.energy();
  const double now_J =
      e.kinetic_J + e.spring_J + 0.5 * 0.02 * joint.velocity_rad_s * joint.velocity_rad_s;
  // The energy of a first-order symplectic step swings by h w / 2 = 1.4 % (50 us), without drift.
  CHECK(now_J == Approx(start_J).epsilon(0.02));
}

TEST_CASE("energy is accounted for") {
  DriveSettings settings = plain_drive();
  settings.coulomb_friction_Nm = 0.3;
  settings.viscous_friction_Nm_s_rad = 0.05;
  settings.gear_damping_Nm_s_rad = 0.5;
  Drive drive(settings);
  drive.enable();
  drive.command({0.5, 0.0, 40.0, 1.0, 0.0});
  Inertia joint{0.02};
  joint.advance(drive, 0.4);
  const DriveEnergy e = drive.energy();
  const double out = e.kinetic_J + e.spring_J + e.friction_J + e.gear_damping_J + e.joint_J;
  REQUIRE(e.motor_J > 0.1);
  CHECK(e.friction_J > 0.0);
  CHECK(e.gear_damping_J > 0.0);
  // First-order sub-steps of 5 us: h w / 2 = 0.1 % of what goes through the gear.
  CHECK(out == Approx(e.motor_J).epsilon(5e-3));
  const double joint_kinetic_J = 0.5 * 0.02 * joint.velocity_rad_s * joint.velocity_rad_s;
  CHECK(e.joint_J == Approx(joint_kinetic_J).margin(1e-6 * e.motor_J));
}
