#include "sim/multibody/ode_world.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/multibody/cube.h"

using namespace hoof::sim;
using Eigen::Vector3d;

namespace {

constexpr double kStep_s = 50e-6;
constexpr double kG_m_s2 = 9.81;

Pose at(const Vector3d& p) {
  return {p, Eigen::Quaterniond::Identity()};
}

/// 2 kg, 0.1 x 0.2 x 0.4 m, its frame in one corner.
MassProperties cornered_block() {
  return solid(make_cuboid({0, 0, 0}, {0.1, 0.2, 0.4}), 2.0);
}

}  // namespace

TEST_CASE("free fall of a body, whatever its frame") {
  OdeWorld world({0.0, 0.0, -kG_m_s2});
  OdeBody body(world, cornered_block(), at({1.0, 2.0, 3.0}));
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) world.step(kStep_s);
  const double t = steps * kStep_s;
  // Semi-implicit Euler falls g t (t + h) / 2: 2.5e-4 more than g t^2 / 2 after 0.2 s.
  const double fall = 3.0 - body.pose().p_WB_m.z();
  CHECK(fall == Approx(0.5 * kG_m_s2 * t * (t + kStep_s)).epsilon(1e-10));
  CHECK(fall == Approx(0.5 * kG_m_s2 * t * t).epsilon(3e-4));
  CHECK(body.velocity_m_s().z() == Approx(-kG_m_s2 * t).epsilon(1e-10));
}

TEST_CASE("a wrench about the frame's origin turns and moves as Newton and Euler say") {
  OdeWorld world(Vector3d::Zero());
  const MassProperties mass = cornered_block();
  OdeBody body(world, mass, at(Vector3d::Zero()));
  const double sign = GENERATE(-1.0, 1.0);
  const Wrench wrench{{0.0, 0.0, sign * 3.0}, {sign * 0.5, 0.0, 0.0}};
  body.apply_wrench(wrench);
  world.step(kStep_s);
  // Torque about the centre: tau - c x f.
  const Vector3d torque = wrench.tau_Bo_W_Nm - mass.com_B_m.cross(wrench.f_W_N);
  const Vector3d expected = mass.inertia_kg_m2.inverse() * torque * kStep_s;
  CHECK((body.angular_velocity_rad_s() - expected).norm() < 1e-12);
  const Vector3d com_velocity =
      body.velocity_m_s() + body.angular_velocity_rad_s().cross(mass.com_B_m);
  // 1e-8: the frame has turned by w h within the step.
  CHECK((com_velocity - wrench.f_W_N / 2.0 * kStep_s).norm() < 1e-8);
  // Forces last for one step.
  const Vector3d before = body.angular_velocity_rad_s();
  world.step(kStep_s);
  CHECK((body.angular_velocity_rad_s() - before).norm() < 1e-9);
}

TEST_CASE("a pendulum swings with the period of the compound pendulum and keeps its energy") {
  OdeWorld world({0.0, 0.0, -kG_m_s2});
  MassProperties rod{1.0, {0.0, 0.0, -0.25}, Eigen::Matrix3d::Identity() * 0.02};
  const double start = GENERATE(-0.05, 0.05);
  const Pose tilted{Vector3d::Zero(),
                    Eigen::Quaterniond(Eigen::AngleAxisd(start, -Vector3d::UnitY()))};
  OdeBody body(world, rod, tilted);
  OdeHinge hinge(world, body, nullptr, Vector3d::Zero(), -Vector3d::UnitY(), start);
  const auto energy_J = [&] { return body.kinetic_J() + 1.0 * kG_m_s2 * body.com_W_m().z(); };
  const double energy_at_start = energy_J();

  // Time from the start to the fourth zero of the angle is 7/4 of a period.
  double t = 0.0;
  int zeros = 0;
  double last = hinge.angle_rad();
  CHECK(last == start);
  while (zeros < 4) {
    world.step(kStep_s);
    t += kStep_s;
    const double angle = hinge.angle_rad();
    if (angle * last < 0.0) ++zeros;
    last = angle;
    REQUIRE(t < 5.0);
  }
  const double inertia = 0.02 + 1.0 * 0.25 * 0.25;
  const double small = 2.0 * std::numbers::pi * std::sqrt(inertia / (kG_m_s2 * 0.25));
  // 1 + start^2 / 16 for the amplitude; a step of 50 us in 2.1 s of time.
  CHECK(t == Approx(1.75 * small * (1.0 + start * start / 16.0)).margin(2 * kStep_s));
  // Swing of 3 mJ above the lowest point; the symplectic step lets it breathe by h w.
  CHECK(energy_J() == Approx(energy_at_start).margin(1e-5));
  CHECK(body.pose().p_WB_m.norm() < 1e-8);  // the hinge holds
}

TEST_CASE("hinge angle, rate and torque share one sign") {
  OdeWorld world(Vector3d::Zero());
  const MassProperties mass{1.0, Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.1};
  OdeBody base(world, mass, at({0, 0, 0}));
  OdeBody moving(world, mass, at({0, 0, 0}));
  const double sign = GENERATE(-1.0, 1.0);
  OdeHinge hinge(world, moving, &base, Vector3d::Zero(), Vector3d::UnitZ(), 0.25);
  hinge.apply_torque(sign * 2.0);
  world.step(kStep_s);
  // Equal inertias turn against each other: relative acceleration 2 tau / I.
  CHECK(hinge.rate_rad_s() == Approx(sign * 2.0 * 2.0 / 0.1 * kStep_s).epsilon(1e-6));
  CHECK(moving.angular_velocity_rad_s().z() * sign > 0.0);
  for (int i = 0; i < 999; ++i) world.step(kStep_s);
  CHECK((hinge.angle_rad() - 0.25) * sign > 0.0);
  CHECK(hinge.angle_rad() - 0.25 == Approx(hinge.rate_rad_s() * 1000 * kStep_s).epsilon(1e-3));
}

TEST_CASE("end stops hold without rebound on both sides") {
  OdeWorld world(Vector3d::Zero());
  const MassProperties mass{1.0, Vector3d::Zero(), Eigen::Matrix3d::Identity() * 0.1};
  OdeBody body(world, mass, at({0, 0, 0}));
  OdeHinge hinge(world, body, nullptr, Vector3d::Zero(), Vector3d::UnitZ(), 0.1);
  hinge.set_stops(-0.2, 0.5);
  const double sign = GENERATE(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    hinge.apply_torque(sign * 5.0);
    world.step(kStep_s);
  }
  CHECK(hinge.angle_rad() == Approx(sign > 0 ? 0.5 : -0.2).margin(1e-4));
  CHECK(std::abs(hinge.rate_rad_s()) < 1e-6);
}

TEST_CASE("a driven slider moves at the given speed against any force, then falls free") {
  OdeWorld world(Vector3d::Zero());
  OdeBody body(world, {2.0, Vector3d::Zero(), Eigen::Matrix3d::Identity()}, at({0, 0, 1.0}));
  OdeSlider slider(world, body, Vector3d::UnitZ());
  const double speed = GENERATE(-0.4, 0.4);
  slider.drive(speed);
  for (int i = 0; i < 1000; ++i) {
    body.apply_force_at_com({100.0, -50.0, 700.0});
    body.apply_torque({3.0, -2.0, 1.0});
    world.step(kStep_s);
  }
  CHECK(body.velocity_m_s().z() == Approx(speed).margin(1e-8));
  CHECK((body.pose().p_WB_m - Vector3d(0, 0, 1.0 + speed * 0.05)).norm() < 1e-7);
  CHECK(body.pose().q_WB.angularDistance(Eigen::Quaterniond::Identity()) < 1e-8);
  slider.release();
  body.apply_force_at_com({0.0, 0.0, 20.0});
  world.step(kStep_s);
  CHECK(body.velocity_m_s().z() == Approx(speed + 10.0 * kStep_s).margin(1e-8));
}
