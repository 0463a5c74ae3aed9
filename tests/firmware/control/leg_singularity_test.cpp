// The postures where a two-link leg goes wrong: stretched, folded, foot at the hip, foot under it.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "firmware/control/leg_kinematics.h"

using namespace hoof::firmware::control;

namespace {

constexpr float kLengths_m[][2] = {{0.3f, 0.3f}, {0.35f, 0.25f}, {0.2f, 0.4f}};

double length(PlaneVector v) {
  return std::hypot(double(v.x), double(v.z));
}

}  // namespace

TEST_CASE("Any point of the reach, all around the hip, is met, knee bent backwards") {
  INFO("seed 41");
  std::mt19937 random(41);
  std::uniform_real_distribution<double> share(0.0, 1.0), direction(-M_PI, M_PI);
  for (const auto& [thigh_m, shank_m] : kLengths_m) {
    const LegKinematics leg(thigh_m, shank_m);
    const double shortest = std::abs(thigh_m - shank_m) + 0.0101 * (thigh_m + shank_m);
    const double longest = 0.9989 * (thigh_m + shank_m);
    for (int n = 0; n < 20000; ++n) {
      const double r = shortest + (longest - shortest) * share(random), a = direction(random);
      const PlaneVector wanted{float(r * std::sin(a)), float(-r * std::cos(a))};
      const LegInverse back = leg.angles(wanted);
      CAPTURE(thigh_m, shank_m, wanted.x, wanted.z);
      REQUIRE(back.reachable);
      REQUIRE(back.angles.knee_rad < 0.0f);
      const PlaneVector foot = leg.foot_m(back.angles);
      // acos near the ends of its range: an error of 4e-7 rad, and of the cosine's last digit,
      // 6e-8, over sin k >= 0.045; times 0.3 m.
      REQUIRE(foot.x == Approx(wanted.x).margin(2e-6));
      REQUIRE(foot.z == Approx(wanted.z).margin(2e-6));
    }
  }
}

TEST_CASE("Stretched, folded and beyond: the nearest point of the reach, and both ends said") {
  for (const auto& [thigh_m, shank_m] : kLengths_m) {
    const LegKinematics leg(thigh_m, shank_m);
    const double sum = thigh_m + shank_m;
    const double shortest = std::abs(thigh_m - shank_m) + 0.01 * sum, longest = 0.999 * sum;
    struct Case {
      double radius, given;
      bool reachable;
    };
    const Case cases[] = {
        {longest - 1e-5, longest - 1e-5, true},
        {longest + 1e-5, longest, false},
        {sum, longest, false},
        {10.0 * sum, longest, false},
        {shortest + 1e-5, shortest + 1e-5, true},
        {shortest - 1e-5, shortest, false},
        {1e-6, shortest, false},
    };
    for (const Case& c : cases) {
      for (const double angle : {-2.0, -0.4, 0.0, 0.4, 2.0}) {
        CAPTURE(thigh_m, shank_m, c.radius, angle);
        const PlaneVector wanted{float(c.radius * std::sin(angle)),
                                 float(-c.radius * std::cos(angle))};
        const LegInverse result = leg.angles(wanted);
        CHECK(result.reachable == c.reachable);
        const PlaneVector foot = leg.foot_m(result.angles);
        CHECK(length(foot) == Approx(c.given).margin(3e-6));
        CHECK(foot.x == Approx(c.given * std::sin(angle)).margin(4e-6));
        CHECK(foot.z == Approx(-c.given * std::cos(angle)).margin(4e-6));
      }
    }
  }
}

TEST_CASE("A foot passing right under the hip moves no joint by a jump") {
  const LegKinematics leg(0.3f, 0.3f);
  LegAngles before = leg.angles({-0.02f, -0.5f}).angles;
  for (int i = -199; i <= 200; ++i) {
    const LegAngles now = leg.angles({float(i) * 1e-4f, -0.5f}).angles;
    // 0.1 mm of 0.5 m: 0.2 mrad of the hip; near this bend the knee takes a part of that.
    REQUIRE(std::abs(now.hip_rad - before.hip_rad) < 2.5e-4f);
    REQUIRE(std::abs(now.knee_rad - before.knee_rad) < 2.5e-4f);
    before = now;
  }
  const LegAngles below = leg.angles({0.0f, -0.5f}).angles;
  CHECK(below.hip_rad == Approx(-0.5 * below.knee_rad).margin(1e-6));  // equal links
}

TEST_CASE("The foot at the hip itself and places that are no numbers are not reachable") {
  const LegKinematics leg(0.3f, 0.3f);
  const LegInverse origin = leg.angles({0.0f, 0.0f});
  CHECK_FALSE(origin.reachable);
  CHECK(is_finite(origin.angles.hip_rad));
  CHECK(is_finite(origin.angles.knee_rad));
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  for (const PlaneVector bad : {PlaneVector{nan, -0.5f}, PlaneVector{0.0f, nan},
                                PlaneVector{infinity, -0.5f}, PlaneVector{0.0f, -infinity}}) {
    CHECK_FALSE(leg.angles(bad).reachable);
  }
}

// The undamped inverse is the transposed cofactors over det J = l1 l2 sin k. Damped, 1/det becomes
// at most 1/threshold, threshold = 0.05 l1 l2, so speeds and forces have a bound of their own.
TEST_CASE("The damped inverse is bounded, continuous, odd in sin k, and exact outside") {
  INFO("seed 42");
  std::mt19937 random(42);
  std::uniform_real_distribution<float> value(-1.0f, 1.0f), hip(-1.2f, 1.6f);
  for (const auto& [thigh_m, shank_m] : kLengths_m) {
    const LegKinematics leg(thigh_m, shank_m);
    const double sum = thigh_m + shank_m, bound = 2.0 * sum / (0.05 * thigh_m * shank_m);
    for (const float around : {0.0f, -kPi}) {
      for (int n = 0; n < 20; ++n) {
        const float h = hip(random);
        const PlaneVector v{value(random), value(random)};
        LegAngles before = leg.joint_velocity_rad_s({h, around - 0.1f}, v);
        for (int i = -1999; i <= 2000; ++i) {
          const LegAngles q{h, around + float(i) * 5e-5f};
          const LegAngles rate = leg.joint_velocity_rad_s(q, v);
          const PlaneVector force = leg.foot_force_N(q, {v.x, v.z});
          CAPTURE(thigh_m, shank_m, h, q.knee_rad, v.x, v.z);
          REQUIRE(std::abs(rate.hip_rad) <= bound);
          REQUIRE(std::abs(rate.knee_rad) <= bound);
          REQUIRE(length(force) <= 2.0 * bound);
          // Steepest at sin k = 0: d(1/det)/dk = l1 l2 / threshold^2 = 400 / (l1 l2) per rad.
          const double step = 2.0 * sum * 400.0 / (thigh_m * shank_m) * 5e-5 * 1.1;
          REQUIRE(std::abs(rate.hip_rad - before.hip_rad) <= step);
          REQUIRE(std::abs(rate.knee_rad - before.knee_rad) <= step);
          before = rate;
        }
        const float out = around == 0.0f ? -0.0502f : around + 0.0502f;  // just outside: exact
        const LegAngles exact = leg.joint_velocity_rad_s({h, out}, v);
        const PlaneVector foot = leg.foot_velocity_m_s(leg.posture({h, out}), exact);
        // Speeds of some 100 rad/s in float, nearly cancelling: 100 * 6e-8 * 20.
        REQUIRE(foot.x == Approx(v.x).margin(2e-4));
        REQUIRE(foot.z == Approx(v.z).margin(2e-4));
      }
      const LegAngles at = leg.joint_velocity_rad_s({0.3f, around}, {1.0f, -1.0f});
      CHECK(std::abs(at.hip_rad) < 1e-3);  // pi in float is not pi
      CHECK(std::abs(at.knee_rad) < 1e-3);
    }
  }
}

TEST_CASE("Foot speed is J qdot: by differences, and the power of force and torque agree") {
  INFO("seed 43");
  std::mt19937 random(43);
  std::uniform_real_distribution<double> hip(-1.2, 1.6), knee(-2.7, 0.05), rate(-4.0, 4.0);
  std::uniform_real_distribution<float> force(-1000.0f, 1000.0f);
  for (const auto& [thigh_m, shank_m] : kLengths_m) {
    const LegKinematics leg(thigh_m, shank_m);
    const double l1 = thigh_m, l2 = shank_m;  // in double: a difference of floats would be coarse
    const auto x = [&](double h, double k) { return l1 * std::sin(h) + l2 * std::sin(h + k); };
    const auto z = [&](double h, double k) { return -l1 * std::cos(h) - l2 * std::cos(h + k); };
    for (int n = 0; n < 5000; ++n) {
      const double h = hip(random), k = knee(random), hd = rate(random), kd = rate(random);
      const PlaneVector f{force(random), force(random)};
      const LegAngles q{float(h), float(k)}, qd{float(hd), float(kd)};
      const PlaneVector v = leg.foot_velocity_m_s(leg.posture(q), qd);
      const double e = 1e-6;
      CAPTURE(thigh_m, shank_m, h, k, hd, kd);
      const double vx = (x(h + hd * e, k + kd * e) - x(h - hd * e, k - kd * e)) / (2 * e);
      const double vz = (z(h + hd * e, k + kd * e) - z(h - hd * e, k - kd * e)) / (2 * e);
      REQUIRE(v.x == Approx(vx).margin(3e-6));  // float digits of 3 m/s
      REQUIRE(v.z == Approx(vz).margin(3e-6));
      const LegAngles tau = leg.joint_torque_Nm(q, f);
      // Kilowatts in float: 4000 * 6e-8, some times over.
      REQUIRE(double(tau.hip_rad) * qd.hip_rad + double(tau.knee_rad) * qd.knee_rad ==
              Approx(double(f.x) * v.x + double(f.z) * v.z).margin(3e-3));
    }
  }
}
