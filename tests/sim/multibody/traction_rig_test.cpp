#include "sim/multibody/traction_rig.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;

namespace {

constexpr double kStep_s = 50e-6;

TractionRigSettings settings_for(const std::string& foot, double x_m, double z_m) {
  TractionRigSettings settings;
  settings.foot = shipped_foot(foot);
  settings.leg = shipped_leg();
  settings.start_x_m = x_m;
  settings.start_z_m = z_m;
  return settings;
}

/// Torques that hold the weight of all parts: gradient of the gravity potential by differences.
LegTorques weight_torques(const TractionRigSettings& at) {
  const LegAngles angles = inverse_kinematics(at.leg, at.start_x_m, at.start_z_m);
  const auto potential = [&at](const LegAngles& a) {
    TractionRigSettings moved = at;
    const LegPoint p = forward_kinematics(at.leg, a);
    moved.start_x_m = p.x_m;
    moved.start_z_m = p.z_m;
    return TractionRig(moved).energy().gravity_J;
  };
  const double h = 1e-4;
  return {(potential({angles.hip_rad + h, angles.knee_rad}) -
           potential({angles.hip_rad - h, angles.knee_rad})) /
              (2 * h),
          (potential({angles.hip_rad, angles.knee_rad + h}) -
           potential({angles.hip_rad, angles.knee_rad - h})) /
              (2 * h)};
}

}  // namespace

TEST_CASE("the leg starts where it is told and reports the angles of the closed form") {
  const auto [x, z] = GENERATE(table<double, double>({{-0.1, 0.005}, {0.1, 0.02}, {0.0, -0.035}}));
  const TractionRigSettings settings = settings_for("bionic", x, z);
  const TractionRig rig(settings);
  const LegAngles angles = inverse_kinematics(settings.leg, x, z);
  CHECK((rig.foot_position_m() - Eigen::Vector3d(x, 0, z)).norm() < 1e-12);
  CHECK(rig.joint_position_rad(Joint::kHip) == Approx(angles.hip_rad).margin(1e-12));
  CHECK(rig.joint_position_rad(Joint::kKnee) == Approx(angles.knee_rad).margin(1e-12));
  CHECK(rig.joints().size() == 3);
}

TEST_CASE("the potential of gravity is that of each part where it hangs") {
  const auto [x, z] = GENERATE(table<double, double>({{-0.1, 0.005}, {0.1, 0.02}, {0.0, -0.035}}));
  const TractionRigSettings settings = settings_for("traditional", x, z);
  const Leg& leg = settings.leg;
  const LegAngles angles = inverse_kinematics(leg, x, z);
  const double knee_z = leg.hip_height_m - leg.thigh.length_m * std::cos(angles.hip_rad);
  const double thigh_z = leg.hip_height_m - leg.thigh.com_from_joint_m * std::cos(angles.hip_rad);
  const double shank_z =
      knee_z - leg.shank.com_from_joint_m * std::cos(angles.hip_rad + angles.knee_rad);
  const double pitch = forward_kinematics(leg, angles).pitch_rad;
  // The block's centre of mass is on its middle line (x = 0).
  const double foot_z = z + solid(settings.foot.middle, 1.0).com_B_m.z() * std::cos(pitch);
  const double expected =
      kGravity_m_s2 *
      (leg.thigh.mass_kg * thigh_z + leg.shank.mass_kg * shank_z + settings.foot.mass_kg * foot_z);
  CHECK(TractionRig(settings).energy().gravity_J == Approx(expected).epsilon(1e-12));
}

TEST_CASE("hip and knee turn forward under positive torque") {
  const Joint joint = GENERATE(Joint::kHip, Joint::kKnee);
  TractionRig rig(settings_for("traditional", 0.0, -0.035));
  TractionRig without(settings_for("traditional", 0.0, -0.035));
  for (int i = 0; i < 200; ++i) {
    rig.apply_joint_torque(joint, 50.0);
    rig.step(kStep_s);
    without.step(kStep_s);
  }
  CHECK(rig.joint_velocity_rad_s(joint) > without.joint_velocity_rad_s(joint) + 0.1);
  CHECK(rig.foot_velocity_m_s().x() > without.foot_velocity_m_s().x());
}

TEST_CASE("angles and foot stay on the closed form while the leg swings freely") {
  const TractionRigSettings settings = settings_for("bionic", 0.1, 0.02);
  TractionRig rig(settings);
  const double start_J = rig.energy().total_J();
  double fastest = 0.0;
  for (int i = 0; i < 1500; ++i) {
    rig.step(kStep_s);
    REQUIRE(rig.joint_position_rad(Joint::kKnee) < -0.1);  // short of its stop, which takes energy
    fastest = std::max(fastest, std::abs(rig.joint_velocity_rad_s(Joint::kHip)));
  }
  REQUIRE(fastest > 1.0);
  const LegAngles angles = {rig.joint_position_rad(Joint::kHip),
                            rig.joint_position_rad(Joint::kKnee)};
  const LegPoint expected = forward_kinematics(settings.leg, angles);
  CHECK(rig.foot_position_m().x() == Approx(expected.x_m).margin(1e-6));
  CHECK(rig.foot_position_m().z() == Approx(expected.z_m).margin(1e-6));
  CHECK(rig.foot_position_m().y() == Approx(0.0).margin(1e-9));
  // Drives off: energy is kept. 10 J are exchanged; a first-order step is good for 1e-4 of it.
  CHECK(rig.energy().total_J() == Approx(start_J).margin(2e-3));
}

TEST_CASE("static torques J^T f plus the weight hold a ground force") {
  const auto [fx, fz] =
      GENERATE(table<double, double>({{260.0, 600.0}, {-150.0, 300.0}, {0.0, 0.0}}));
  const TractionRigSettings settings = settings_for("bionic", 0.03, -0.03);
  TractionRig rig(settings);
  const LegAngles angles = inverse_kinematics(settings.leg, 0.03, -0.03);
  const LegTorques ground = holding_torques(settings.leg, angles, fx, fz);
  const LegTorques weight = weight_torques(settings);
  for (int i = 0; i < 200; ++i) {
    rig.apply_wrench(0, {{fx, 0.0, fz}, {0.0, 0.0, 0.0}});
    rig.apply_joint_torque(Joint::kHip, ground.hip_Nm + weight.hip_Nm);
    rig.apply_joint_torque(Joint::kKnee, ground.knee_Nm + weight.knee_Nm);
    rig.step(kStep_s);
  }
  // Unheld, 260 N would give some 0.5 m/s in these 10 ms.
  CHECK(rig.foot_velocity_m_s().norm() < 1e-4);
}

TEST_CASE("the knee never straightens beyond its stop") {
  const TractionRigSettings settings = settings_for("traditional", 0.0, -0.09);
  TractionRig rig(settings);
  double most = -10.0;
  for (int i = 0; i < 10000; ++i) {
    rig.apply_joint_torque(Joint::kKnee, 20.0);
    rig.step(kStep_s);
    most = std::max(most, rig.joint_position_rad(Joint::kKnee));
  }
  // It arrives with about 10 rad/s, 0.5 mrad in the step in which it meets the stop.
  CHECK(most == Approx(-5.0 * M_PI / 180.0).margin(1e-3));
}
