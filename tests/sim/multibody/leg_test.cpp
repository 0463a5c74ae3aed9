#include "sim/multibody/leg.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;

TEST_CASE("inverse and forward kinematics agree on the whole ellipse") {
  const Leg leg = shipped_leg();
  for (int i = 0; i < 360; ++i) {
    const double phase = i * std::numbers::pi / 180.0;
    const double x = -0.1 * std::cos(phase);
    const double z = 0.005 - 0.04 * std::sin(phase);
    const LegAngles angles = inverse_kinematics(leg, x, z);
    const LegPoint foot = forward_kinematics(leg, angles);
    CHECK(foot.x_m == Approx(x).margin(1e-14));
    CHECK(foot.z_m == Approx(z).margin(1e-14));
    CHECK(angles.knee_rad < 0.0);
  }
}

TEST_CASE("the sole is level at the deepest point and pitches -16 to +7 degrees in stance") {
  Leg leg = shipped_leg();
  leg.level_sole_z_m = -0.035;  // the deepest point of the reference's ellipse, 40 mm about 5 mm
  const auto pitch_deg = [&leg](double x, double z) {
    return forward_kinematics(leg, inverse_kinematics(leg, x, z)).pitch_rad * 180.0 /
           std::numbers::pi;
  };
  CHECK(pitch_deg(0.0, -0.035) == Approx(0.0).margin(1e-12));
  double least = 0.0;
  double most = 0.0;
  for (int i = 0; i <= 720; ++i) {
    const double phase = i * std::numbers::pi / 360.0;
    const double z = 0.005 - 0.04 * std::sin(phase);
    if (z >= 0.0) continue;
    const double pitch = pitch_deg(-0.1 * std::cos(phase), z);
    least = std::min(least, pitch);
    most = std::max(most, pitch);
  }
  CHECK(least == Approx(-16.0).margin(0.6));  // the reference is given in whole degrees
  CHECK(most == Approx(7.0).margin(0.6));
}

TEST_CASE("holding torques are -J^T f, the Jacobian by differences") {
  const Leg leg = shipped_leg();
  const unsigned seed = 20260715;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-0.2, 0.2), z(-0.05, 0.2), force(-500.0, 500.0);
  for (int i = 0; i < 50; ++i) {
    const LegAngles angles = inverse_kinematics(leg, x(random), z(random));
    const double fx = force(random);
    const double fz = force(random);
    const double h = 1e-6;
    const auto work = [&](double dhip, double dknee) {
      const LegPoint p = forward_kinematics(leg, {angles.hip_rad + dhip, angles.knee_rad + dknee});
      return p.x_m * fx + p.z_m * fz;
    };
    const LegTorques torques = holding_torques(leg, angles, fx, fz);
    // Central differences: h^2 relative, and 1e-16 * 600 J / h of rounding.
    CHECK(torques.hip_Nm == Approx(-(work(h, 0) - work(-h, 0)) / (2 * h)).margin(1e-6));
    CHECK(torques.knee_Nm == Approx(-(work(0, h) - work(0, -h)) / (2 * h)).margin(1e-6));
  }
}

TEST_CASE("at the deepest point the hip carries the paper's 139 and 235 Nm") {
  const Leg leg = shipped_leg();
  const LegAngles deepest = inverse_kinematics(leg, 0.0, -0.035);
  CHECK(holding_torques(leg, deepest, 260.0, 600.0).hip_Nm == Approx(-139.0).margin(0.5));
  CHECK(holding_torques(leg, deepest, 440.0, 1075.0).hip_Nm == Approx(-235.0).margin(0.5));
}

TEST_CASE("a point out of reach is refused with the reach") {
  const Leg leg = shipped_leg();
  CHECK_THROWS_WITH(inverse_kinematics(leg, 0.0, -0.2),
                    "foot at x = 0 mm, z = -200 mm: must be within reach of the leg, 0 to 600 mm "
                    "from the hip");
}
