#include "firmware/control/leg_kinematics.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>

using namespace hoof::firmware::control;

namespace {

const LegKinematics kLeg(0.3f, 0.3f);

std::mt19937 seeded(unsigned seed) {
  return std::mt19937(seed);
}

LegAngles random_posture(std::mt19937& random) {
  std::uniform_real_distribution<float> hip(-1.2f, 1.6f);
  std::uniform_real_distribution<float> knee(-2.6f, -0.2f);
  return {hip(random), knee(random)};
}

}  // namespace

TEST_CASE("Postures whose foot can be told without a formula") {
  struct Case {
    LegAngles q;
    PlaneVector foot;
  };
  const float half = kHalfPi;
  const Case cases[] = {
      {{0, 0}, {0, -0.6f}},       {{half, 0}, {0.6f, 0}},       {{-half, 0}, {-0.6f, 0}},
      {{0, half}, {0.3f, -0.3f}}, {{0, -half}, {-0.3f, -0.3f}}, {{half, -half}, {0.3f, -0.3f}},
      {{0, -2 * half}, {0, 0}},
  };
  for (const Case& c : cases) {
    CHECK(kLeg.foot_m(c.q).x == Approx(c.foot.x).margin(1e-6));  // float at 0.6 m
    CHECK(kLeg.foot_m(c.q).z == Approx(c.foot.z).margin(1e-6));
  }
}

TEST_CASE("From posture to foot and back") {
  INFO("seed 21");
  std::mt19937 random = seeded(21);
  for (int n = 0; n < 20000; ++n) {
    const LegAngles q = random_posture(random);
    const LegInverse back = kLeg.angles(kLeg.foot_m(q));
    CAPTURE(q.hip_rad, q.knee_rad);
    REQUIRE(back.reachable);
    // Rounding of 6e-8 grows with 1/sin(knee), at most 5 here, and in acos near its ends.
    REQUIRE(back.angles.hip_rad == Approx(q.hip_rad).margin(1e-5));
    REQUIRE(back.angles.knee_rad == Approx(q.knee_rad).margin(1e-5));
  }
}

TEST_CASE("Lengths that differ, hip and knee by the law of cosines") {
  const LegKinematics leg(0.35f, 0.25f);
  const LegInverse result = leg.angles({0.0f, -0.5f});
  REQUIRE(result.reachable);
  const double knee =
      -(3.14159265358979 - std::acos((0.35 * 0.35 + 0.25 * 0.25 - 0.25) / (2 * 0.35 * 0.25)));
  CHECK(result.angles.knee_rad == Approx(knee).margin(1e-6));
  CHECK(leg.foot_m(result.angles).x == Approx(0.0).margin(1e-6));
  CHECK(leg.foot_m(result.angles).z == Approx(-0.5).margin(1e-6));
}

TEST_CASE("A point out of reach gives the nearest posture in its direction and says so") {
  for (const PlaneVector point : {PlaneVector{0.0f, -0.7f}, PlaneVector{0.5f, -0.5f},
                                  PlaneVector{-2.0f, -1.0f}, PlaneVector{0.001f, -0.001f}}) {
    const LegInverse result = kLeg.angles(point);
    CHECK_FALSE(result.reachable);
    const PlaneVector foot = kLeg.foot_m(result.angles);
    // Same direction: the cross product vanishes.
    CHECK(foot.x * point.z - foot.z * point.x == Approx(0.0).margin(1e-6));
    CHECK(foot.x * point.x + foot.z * point.z > 0.0f);
  }
  CHECK(kLeg.angles({0.0f, 0.0f}).reachable == false);
}

TEST_CASE("The Jacobian is the derivative of the foot's place") {
  INFO("seed 22");
  std::mt19937 random = seeded(22);
  const auto foot = [](double h, double k) {  // double: a difference of floats would be coarse
    return std::pair{0.3 * std::sin(h) + 0.3 * std::sin(h + k),
                     -0.3 * std::cos(h) - 0.3 * std::cos(h + k)};
  };
  for (int n = 0; n < 2000; ++n) {
    const LegAngles q = random_posture(random);
    const LegJacobian j = kLeg.jacobian(q);
    const double e = 1e-6;
    const auto [xh1, zh1] = foot(q.hip_rad + e, q.knee_rad);
    const auto [xh0, zh0] = foot(q.hip_rad - e, q.knee_rad);
    const auto [xk1, zk1] = foot(q.hip_rad, q.knee_rad + e);
    const auto [xk0, zk0] = foot(q.hip_rad, q.knee_rad - e);
    REQUIRE(j.x_h == Approx((xh1 - xh0) / (2 * e)).margin(1e-6));
    REQUIRE(j.z_h == Approx((zh1 - zh0) / (2 * e)).margin(1e-6));
    REQUIRE(j.x_k == Approx((xk1 - xk0) / (2 * e)).margin(1e-6));
    REQUIRE(j.z_k == Approx((zk1 - zk0) / (2 * e)).margin(1e-6));
  }
}

TEST_CASE("What a posture holds is what its angles alone give, bit for bit") {
  INFO("seed 27");
  std::mt19937 random = seeded(27);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  LegPosture kept = kLeg.posture({});
  for (int n = 0; n < 5000; ++n) {
    LegAngles q = random_posture(random);
    if (n % 50 == 0) q.knee_rad *= 0.01f;  // nearly stretched
    CAPTURE(q.hip_rad, q.knee_rad);
    kLeg.update(kept, q);
    kLeg.update(kept, q);
    // Each sine anew, as if the others were not known.
    const SinCos h = sin_cos(q.hip_rad), s = sin_cos(q.hip_rad + q.knee_rad);
    const float l1 = 0.3f, l2 = 0.3f;
    REQUIRE(bits(kept.foot_m.x) == bits(l1 * h.sin + l2 * s.sin));
    REQUIRE(bits(kept.foot_m.z) == bits(-l1 * h.cos - l2 * s.cos));
    REQUIRE(bits(kept.jacobian.x_k) == bits(l2 * s.cos));
    REQUIRE(bits(kept.jacobian.z_k) == bits(l2 * s.sin));
    const LegAngles v{value(random), value(random)};
    const LegJacobian& j = kept.jacobian;
    const PlaneVector speed = kLeg.foot_velocity_m_s(kept, v);
    REQUIRE(bits(speed.x) == bits(j.x_h * v.hip_rad + j.x_k * v.knee_rad));
    REQUIRE(bits(speed.z) == bits(j.z_h * v.hip_rad + j.z_k * v.knee_rad));
    const PlaneVector f = kLeg.foot_force_N(kept, v), again = kLeg.foot_force_N(q, v);
    REQUIRE(bits(f.x) == bits(again.x));
    REQUIRE(bits(f.z) == bits(again.z));
  }
}

TEST_CASE("A posture whose angles differ in the sign of a zero alone is reckoned anew") {
  LegPosture posture = kLeg.posture({0.0f, 0.0f});
  kLeg.update(posture, {-0.0f, 0.0f});
  CHECK(std::signbit(posture.q.hip_rad));
}

TEST_CASE("Joint speeds give the wanted foot speed; forces and torques go both ways") {
  INFO("seed 23");
  std::mt19937 random = seeded(23);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f);
  for (int n = 0; n < 5000; ++n) {
    const LegAngles q = random_posture(random);
    const PlaneVector v{value(random), value(random)};
    const LegAngles rate = kLeg.joint_velocity_rad_s(q, v);
    const LegJacobian j = kLeg.jacobian(q);
    CAPTURE(q.hip_rad, q.knee_rad, v.x, v.z);
    REQUIRE(j.x_h * rate.hip_rad + j.x_k * rate.knee_rad == Approx(v.x).margin(2e-5));
    REQUIRE(j.z_h * rate.hip_rad + j.z_k * rate.knee_rad == Approx(v.z).margin(2e-5));
    const PlaneVector f{400.0f * v.x, 1000.0f * v.z};
    const PlaneVector back = kLeg.foot_force_N(q, kLeg.joint_torque_Nm(q, f));
    REQUIRE(back.x == Approx(f.x).margin(0.02));
    REQUIRE(back.z == Approx(f.z).margin(0.02));
    // Power is the same on both sides: F v = tau qdot.
    const LegAngles tau = kLeg.joint_torque_Nm(q, f);
    REQUIRE(tau.hip_rad * rate.hip_rad + tau.knee_rad * rate.knee_rad ==
            Approx(f.x * v.x + f.z * v.z).margin(0.05));
  }
}

TEST_CASE("Joint accelerations are the second derivative of a known motion") {
  // The foot on a circle of radius r with angular speed w: exact velocity and acceleration.
  const double r = 0.08, w = 5.0, h = 1e-4;
  const auto posture = [&](double t) {
    const double x = r * std::cos(w * t), z = -0.48 + r * std::sin(w * t);
    const double c = (x * x + z * z - 0.18) / 0.18;
    const double k = -std::acos(c);
    return std::pair{std::atan2(x, -z) - std::atan2(0.3 * std::sin(k), 0.3 + 0.3 * std::cos(k)), k};
  };
  for (double t = 0.0; t < 1.25; t += 0.01) {
    const auto [h0, k0] = posture(t - h);
    const auto [h1, k1] = posture(t);
    const auto [h2, k2] = posture(t + h);
    const LegAngles q{float(h1), float(k1)};
    const PlaneVector v{float(-r * w * std::sin(w * t)), float(r * w * std::cos(w * t))};
    const PlaneVector a{float(-r * w * w * std::cos(w * t)), float(-r * w * w * std::sin(w * t))};
    const LegAngles qd = kLeg.joint_velocity_rad_s(q, v);
    const LegAngles qdd = kLeg.joint_acceleration_rad_s2(q, qd, a);
    CHECK(qd.hip_rad == Approx((h2 - h0) / (2 * h)).margin(1e-4));
    CHECK(qd.knee_rad == Approx((k2 - k0) / (2 * h)).margin(1e-4));
    CHECK(qdd.hip_rad == Approx((h2 - 2 * h1 + h0) / (h * h)).margin(5e-3));
    CHECK(qdd.knee_rad == Approx((k2 - 2 * k1 + k0) / (h * h)).margin(5e-3));
  }
}

TEST_CASE("Near the stretched leg joint speeds stay bounded, and continuous at the threshold") {
  const PlaneVector down{0.0f, -1.0f};
  float worst = 0.0f;
  float previous = kLeg.joint_velocity_rad_s({0.1f, -0.2f}, down).knee_rad;
  for (int i = 2000; i >= -2000; --i) {
    const float knee = -static_cast<float>(i) * 1e-4f;
    const float speed = kLeg.joint_velocity_rad_s({0.1f, knee}, down).knee_rad;
    worst = std::max(worst, std::abs(speed));
    CHECK(std::abs(speed - previous) < 1.5f);  // 0.1 mrad further; an undamped pole jumps to 1e5
    previous = speed;
  }
  CHECK(worst < 150.0f);
  CHECK(kLeg.joint_velocity_rad_s({0.1f, 0.0f}, down).knee_rad == 0.0f);
}
