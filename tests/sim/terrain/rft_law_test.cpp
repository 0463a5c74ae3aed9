#include "sim/terrain/rft_law.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace hoof::sim;
using Eigen::Vector3d;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kRough = 1e9;

/// Normal and velocity in the frame of the source: r = x, theta = y.
Vector3d normal(double beta_deg, double psi_deg = 0) {
  const double b = beta_deg * kDegree, p = psi_deg * kDegree;
  return {std::sin(b) * std::cos(p), std::sin(b) * std::sin(p), -std::cos(b)};
}

Vector3d velocity(double gamma_deg) {
  return {std::cos(gamma_deg * kDegree), 0, -std::sin(gamma_deg * kDegree)};
}

Vector3d random_unit(std::mt19937& random) {
  std::normal_distribution<double> gauss;
  return Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
}

}  // namespace

TEST_CASE("the law has the values that the published coefficients give") {
  // By hand from the table, all 60 terms: x1 = x2 = x3 = 1.
  CHECK(rft::flat_plate_alpha() == Approx(1.05614).margin(1e-5));
  CHECK(rft::generic_alpha(normal(0), velocity(90)).head<2>().norm() < 1e-12);
  struct Case {
    double beta_deg, gamma_deg, x, z;
  };
  // Evaluated apart from this code, in another language, from the tables and the source's angles.
  for (const Case& c :
       {Case{30, 90, -0.140, 1.045}, Case{-30, 90, 0.140, 1.045}, Case{0, 60, -0.155, 0.988},
        Case{30, 30, -0.387, 0.689}, Case{60, 0, -0.358, 0.249}, Case{90, 30, -0.284, 0.116},
        Case{-30, 60, -0.025, 0.822}}) {
    CAPTURE(c.beta_deg, c.gamma_deg);
    const Vector3d a = rft::generic_alpha(normal(c.beta_deg), velocity(c.gamma_deg));
    CHECK(a.x() == Approx(c.x).margin(6e-4));  // the values above have three decimals
    CHECK(a.z() == Approx(c.z).margin(6e-4));
    CHECK(std::abs(a.y()) < 1e-12);
  }
}

TEST_CASE("a flat plate meets more straight down than a tilted one, as in measurements") {
  // Li, Zhang, Goldman, Science 339 (2013) 1408, generic coefficients: 1.00 flat, 0.78 at 30 deg,
  // 0.35 at 60 deg. This decides between the two readings of the table: the other gives 0.88 flat
  // and 0.93 at 30 deg.
  const double flat = rft::flat_plate_alpha();
  for (const double beta : {30.0, 45.0, 60.0, 90.0}) {
    CAPTURE(beta);
    CHECK(rft::generic_alpha(normal(beta), velocity(90)).z() < flat);
    CHECK(rft::generic_alpha(normal(-beta), velocity(90)).z() < flat);
  }
}

TEST_CASE("resistance is against the motion, in all directions alike") {
  for (const double gamma : {10.0, 45.0, 80.0}) {
    const Vector3d ahead = rft::alpha(normal(40), velocity(gamma), kRough);
    CAPTURE(gamma);
    CHECK(ahead.x() < 0);
    CHECK(ahead.z() > 0);
    // Mirrored in x: the other way round.
    const Vector3d back = rft::alpha(Vector3d(-1, 1, 1).cwiseProduct(normal(40)),
                                     Vector3d(-1, 1, 1).cwiseProduct(velocity(gamma)), kRough);
    CHECK((back - Vector3d(-1, 1, 1).cwiseProduct(ahead)).norm() < 1e-12);
  }
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d n = random_unit(random), v = random_unit(random);
    const double turn = std::uniform_real_distribution<double>(0, 6.28)(random);
    const Eigen::AngleAxisd yaw(turn, Vector3d::UnitZ());
    INFO("n = " << n.transpose() << ", v = " << v.transpose() << ", turn = " << turn);
    const Vector3d a = rft::alpha(n, v, 0.6);
    CHECK((rft::alpha(yaw * n, yaw * v, 0.6) - yaw * a).norm() < 1e-12);
    const Vector3d mirror(1, -1, 1);
    CHECK((rft::alpha(mirror.cwiseProduct(n), mirror.cwiseProduct(v), 0.6) - mirror.cwiseProduct(a))
              .norm() < 1e-12);
    CHECK(a.dot(v) <= 0);
    // A plate, not a side of it.
    CHECK((rft::generic_alpha(-n, v) - rft::generic_alpha(n, v)).norm() < 1e-12);
    CHECK(a.dot(n) <= 0);
    CHECK((a - a.dot(n) * n).norm() <= 0.6 * -a.dot(n) + 1e-12);
    if (n.dot(v) <= 0) CHECK(a == Vector3d::Zero());
  }
}

TEST_CASE("friction cuts the tangential part and nothing else") {
  const Vector3d n = normal(30), v = velocity(20);
  const Vector3d rough = rft::alpha(n, v, kRough), smooth = rft::alpha(n, v, 0);
  CHECK(rough.dot(n) == Approx(smooth.dot(n)));
  CHECK((smooth - smooth.dot(n) * n).norm() < 1e-12);
  const Vector3d some = rft::alpha(n, v, 0.05);
  CHECK((some - some.dot(n) * n).norm() == Approx(-0.05 * some.dot(n)));
}

TEST_CASE("the sand's scale and Bekker's pressure are their formulas") {
  // 3000 kg/m^3 and 0.4: 894 * 0.064 - 386 * 0.16 + 89 * 0.4 = 31.056.
  CHECK(rft::predicted_xi_n_N_m3(3000, 0.4) == Approx(3000 * 9.81 * 31.056));
  CHECK(rft::bekker_pressure_Pa(100, 2e4, 1, 0.05, 0.02) == Approx((2000 + 2e4) * 0.02));
  CHECK(rft::bekker_pressure_Pa(100, 2e4, 0.5, 0.05, 0.0004) == Approx((2000 + 2e4) * 0.02));
  CHECK(rft::bekker_pressure_Pa(100, 2e4, 0.5, 0.05, -1e-3) == 0);
}
