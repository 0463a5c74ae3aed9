#include "sim/multibody/sinkage_rig.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/sim/multibody/shipped.h"

using namespace hoof::sim;

namespace {

constexpr double kStep_s = 50e-6;

SinkageRigSettings settings_for(const std::string& foot, LoadAs load_as = LoadAs::kForce) {
  SinkageRigSettings settings;
  settings.foot = shipped_foot(foot);
  settings.load_N = 40.0 * kGravity_m_s2;
  settings.load_as = load_as;
  settings.start_height_m = 0.02;
  return settings;
}

void run(Rig& rig, double time_s) {
  const int steps = static_cast<int>(std::lround(time_s / kStep_s));
  for (int i = 0; i < steps; ++i) rig.step(kStep_s);
}

}  // namespace

TEST_CASE("held, lowered and released") {
  SinkageRig rig(settings_for("bionic"));
  CHECK(rig.body_count() == 3);
  run(rig, 0.1);
  CHECK(rig.foot_position_m().z() == Approx(0.02).margin(1e-12));
  rig.lower(0.1);
  run(rig, 0.1);
  CHECK(rig.foot_position_m().z() == Approx(0.01).margin(1e-8));
  CHECK(rig.foot_velocity_m_s().z() == Approx(-0.1).margin(1e-9));
  rig.hold();
  run(rig, 0.1);
  CHECK(rig.foot_position_m().z() == Approx(0.01).margin(1e-5));  // one step at 0.1 m/s is 5 um
}

TEST_CASE("after release the load accelerates the mass that belongs to it") {
  const auto [load_as, mass_kg] =
      GENERATE(table<LoadAs, double>({{LoadAs::kForce, 1.5}, {LoadAs::kMass, 40.0}}));
  SinkageRig rig(settings_for("bionic", load_as));
  CHECK(rig.moving_mass_kg() == Approx(mass_kg).epsilon(1e-12));
  rig.lower(0.1);
  run(rig, 0.01);
  rig.release();
  run(rig, 0.02);
  CHECK(rig.foot_velocity_m_s().z() ==
        Approx(-0.1 - 40.0 * kGravity_m_s2 / mass_kg * 0.02).epsilon(1e-6));
}

TEST_CASE("a ground force equal to the load leaves the foot at rest, uneven or not") {
  SinkageRig rig(settings_for("traditional"));
  CHECK(rig.body_count() == 1);
  CHECK(rig.joints().empty());
  rig.release();
  for (int i = 0; i < 2000; ++i) {
    // Off the middle and with side forces: the slider takes what is not vertical.
    rig.apply_wrench(0, {{20.0, -10.0, 40.0 * kGravity_m_s2}, {5.0, -3.0, 2.0}});
    rig.step(kStep_s);
  }
  CHECK(rig.foot_position_m().z() == Approx(0.02).margin(1e-8));
  CHECK(rig.foot_velocity_m_s().norm() < 1e-7);
}

TEST_CASE("the toe torque opens both toes alike, outward positive, to their stops") {
  SinkageRig rig(settings_for("bionic"));
  const double sign = GENERATE(-1.0, 1.0);
  for (int i = 0; i < 8000; ++i) {
    rig.apply_joint_torque(Joint::kToe, sign * 1.0);
    rig.step(kStep_s);
    REQUIRE(rig.toe_opening_rad(0) == Approx(rig.toe_opening_rad(1)).margin(1e-9));
  }
  const double stop = sign > 0 ? 45.0 : -2.0;
  CHECK(rig.joint_position_rad(Joint::kToe) * 180.0 / M_PI == Approx(stop).margin(0.01));
  // The left toe's tip has moved to +y for an opening foot, the right one's to -y.
  const auto tip_y = [&rig](int body) {
    const Pose pose = rig.pose(body);
    return (pose.p_WB_m + pose.q_WB * Eigen::Vector3d(0.145, 0, 0)).y();
  };
  CHECK(sign * (tip_y(1) - 0.033) > 0.0);
  CHECK(sign * (tip_y(2) + 0.033) < 0.0);
}

TEST_CASE("toe torque accelerates the mean opening by torque over both inertias") {
  SinkageRig rig(settings_for("bionic"));
  const double torque_Nm = GENERATE(-0.5, 0.5);
  rig.apply_joint_torque(Joint::kToe, torque_Nm);
  rig.step(kStep_s);
  // Work tau dm on two toes that both turn by dm: (I + I) dw/dt = tau.
  const Foot foot = shipped_foot("bionic");
  const double volume = volume_m3(foot.middle) + 2.0 * volume_m3(foot.left_toe);
  const MassProperties toe = solid(foot.left_toe, foot.mass_kg * volume_m3(foot.left_toe) / volume);
  const double inertia =
      toe.inertia_kg_m2(2, 2) + toe.mass_kg * toe.com_B_m.head<2>().squaredNorm();
  CHECK(rig.joint_velocity_rad_s(Joint::kToe) ==
        Approx(torque_Nm / (2.0 * inertia) * kStep_s).epsilon(1e-6));
}

TEST_CASE("sand against one toe alone moves both: the linkage is stiff") {
  SinkageRig rig(settings_for("bionic"));
  const double push_N = GENERATE(-20.0, 20.0);
  double largest = 0.0;
  // 1.45 Nm on the left toe, the drive's half of it on each toe against: only the difference is
  // left.
  for (int i = 0; i < 20000; ++i) {
    const Pose left = rig.pose(1);
    rig.apply_wrench(1, {left.q_WB * Eigen::Vector3d(0, push_N, 0),
                         left.q_WB * Eigen::Vector3d(0, 0, 0.0725 * push_N)});
    rig.apply_joint_torque(Joint::kToe, -0.0725 * push_N);
    rig.step(kStep_s);
    largest = std::max(largest, std::abs(rig.toe_opening_rad(0) - rig.toe_opening_rad(1)));
  }
  // Each toe is left with +-tau/2 against k times the difference: diff = tau / (2 k).
  const double difference = rig.toe_opening_rad(0) - rig.toe_opening_rad(1);
  CHECK(difference == Approx(0.0725 * push_N / 2.0 / 3000.0).epsilon(1e-2));
  CHECK(largest < 3.0 * std::abs(difference));
  CHECK(std::abs(rig.joint_position_rad(Joint::kToe)) < 1e-3);
}

TEST_CASE("a load that is impossible is refused") {
  SinkageRigSettings negative = settings_for("bionic");
  negative.load_N = -1.0;
  CHECK_THROWS_WITH(SinkageRig(negative), "load = -1 N: must be above 0");
  SinkageRigSettings light = settings_for("bionic", LoadAs::kMass);
  light.load_N = 10.0;
  CHECK_THROWS_WITH(SinkageRig(light),
                    "load = 10 N as a mass: must be above the weight of the foot, 14.715 N");
}

TEST_CASE("two runs give the same bits") {
  const auto run_once = [] {
    SinkageRig rig(settings_for("bionic"));
    rig.release();
    for (int i = 0; i < 500; ++i) {
      rig.apply_wrench(1, {{1.0, 2.0, 300.0}, {0.3, 0.1, 0.7}});
      rig.apply_joint_torque(Joint::kToe, 0.5);
      rig.step(kStep_s);
    }
    return rig.pose(1);
  };
  const Pose a = run_once();
  const Pose b = run_once();
  CHECK(std::memcmp(a.p_WB_m.data(), b.p_WB_m.data(), 3 * sizeof(double)) == 0);
  CHECK(std::memcmp(a.q_WB.coeffs().data(), b.q_WB.coeffs().data(), 4 * sizeof(double)) == 0);
}
