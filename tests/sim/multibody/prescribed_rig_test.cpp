#include "sim/multibody/prescribed_rig.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;

TEST_CASE("the foot follows the path exactly, whatever pushes it, at the pitch of the leg") {
  const Leg leg = shipped_leg();
  const auto point = [](double t) {
    const double phase = 2.0 * std::numbers::pi * 0.45 * t;
    return FootPoint{0.1 * std::cos(phase), 0.005 - 0.04 * std::sin(phase)};
  };
  PrescribedRig rig(shipped_foot("bionic"), leg, point(0.0));
  const double step_s = 50e-6;
  for (int i = 1; i <= 10000; ++i) {
    rig.move_to(point(i * step_s));
    rig.apply_wrench(0, {{400.0, -100.0, 900.0}, {10.0, 20.0, -30.0}});
    rig.apply_joint_torque(Joint::kToe, -0.1);
    rig.step(step_s);
  }
  const double t = 10000 * step_s;
  const FootPoint now = point(t);
  CHECK(rig.foot_position_m().x() == Approx(now.x_m).margin(1e-12));
  CHECK(rig.foot_position_m().z() == Approx(now.z_m).margin(1e-12));
  const double w = 2.0 * std::numbers::pi * 0.45;
  CHECK(rig.foot_velocity_m_s().x() == Approx(-0.1 * w * std::sin(w * t)).margin(1e-4));
  CHECK(rig.foot_velocity_m_s().z() == Approx(-0.04 * w * std::cos(w * t)).margin(1e-4));
  const double pitch = forward_kinematics(leg, inverse_kinematics(leg, now.x_m, now.z_m)).pitch_rad;
  const Eigen::Vector3d forward = rig.pose(0).q_WB * Eigen::Vector3d::UnitX();
  CHECK(std::atan2(forward.z(), forward.x()) == Approx(pitch).margin(1e-12));

  // The toes ride along on their hinges, held at the closing stop by the torque.
  const Pose middle = rig.pose(0);
  const Eigen::Vector3d hinge = middle.p_WB_m + middle.q_WB * Eigen::Vector3d(-0.0625, 0.033, 0);
  CHECK((rig.pose(1).p_WB_m - hinge).norm() < 1e-5);
  CHECK(rig.toe_opening_rad(0) * 180.0 / std::numbers::pi == Approx(-2.0).margin(0.02));
}

TEST_CASE("a path out of the leg's reach is refused") {
  PrescribedRig rig(shipped_foot("traditional"), shipped_leg(), {0.0, 0.0});
  CHECK_THROWS_AS(rig.move_to({0.0, -0.2}), std::invalid_argument);
}
