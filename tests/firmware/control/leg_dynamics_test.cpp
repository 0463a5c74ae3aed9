#include "firmware/control/leg_dynamics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof::firmware::control;

namespace {

LegModelSettings frictionless() {
  LegModelSettings settings;
  settings.friction_Nm = settings.viscous_friction_Nm_s_rad = 0.0f;
  return settings;
}

/// Energy of the same links by positions and speeds of their centres, in double.
double energy_J(const LegModelSettings& m, double h, double k, double hd, double kd) {
  const double s = h + k, sd = hd + kd, g = 9.80665;
  const auto link = [&](double mass, double inertia, double above, double along) {
    const double x = above * std::sin(h) + along * std::sin(s);
    (void)x;
    const double z = -above * std::cos(h) - along * std::cos(s);
    const double xd = above * std::cos(h) * hd + along * std::cos(s) * sd;
    const double zd = above * std::sin(h) * hd + along * std::sin(s) * sd;
    return mass * (0.5 * (xd * xd + zd * zd) + g * z) + 0.5 * inertia * sd * sd;
  };
  const double thigh_xd = m.thigh_centre_m * hd;
  return m.thigh_mass_kg * (0.5 * thigh_xd * thigh_xd - g * m.thigh_centre_m * std::cos(h)) +
         0.5 * m.thigh_inertia_kg_m2 * hd * hd +
         link(m.shank_mass_kg, m.shank_inertia_kg_m2, m.thigh_m, m.shank_centre_m) +
         link(m.foot_mass_kg, 0.0, m.thigh_m, m.foot_centre_m) +
         0.5 * m.rotor_inertia_kg_m2 * (hd * hd + kd * kd);
}

}  // namespace

TEST_CASE("Hanging straight down needs no torque; held out level it needs the mass moments") {
  const LegModelSettings m = frictionless();
  const LegDynamics leg(m);
  CHECK(leg.torque_Nm({0, 0}, {}, {}).hip_rad == Approx(0.0).margin(1e-5));
  const double shank = 9.80665 * (1.0 * 0.15 + 1.5 * 0.28);
  const double both = shank + 9.80665 * (2.0 * 0.15 + 2.5 * 0.3);
  for (const float side : {1.0f, -1.0f}) {
    const LegAngles tau = leg.torque_Nm({side * kHalfPi, 0.0f}, {}, {});
    CHECK(tau.hip_rad == Approx(side * both).epsilon(1e-5));
    CHECK(tau.knee_rad == Approx(side * shank).epsilon(1e-5));
  }
}

TEST_CASE("From rest a joint alone feels its own inertia and the rotor") {
  LegModelSettings m = frictionless();
  const LegDynamics leg(m);
  // Straight down, knee accelerated by 1: inertia of shank and foot about the knee, and the rotor.
  const double shank = 0.0075 + 1.0 * 0.15 * 0.15 + 1.5 * 0.28 * 0.28 + m.rotor_inertia_kg_m2;
  CHECK(leg.torque_Nm({0, 0}, {}, {0, 1}).knee_rad == Approx(shank).epsilon(1e-5));
}

TEST_CASE("The power of the torques is the change of energy, in any motion") {
  INFO("seed 31");
  std::mt19937 random(31);
  std::uniform_real_distribution<double> angle(-1.5, 1.5), rate(-4.0, 4.0), accel(-40.0, 40.0);
  const LegModelSettings m = frictionless();
  const LegDynamics leg(m);
  for (int n = 0; n < 5000; ++n) {
    const double h = angle(random), k = angle(random), hd = rate(random), kd = rate(random);
    const double hdd = accel(random), kdd = accel(random), e = 1e-6;
    const auto at = [&](double t) {
      return energy_J(m, h + hd * t + hdd * t * t / 2, k + kd * t + kdd * t * t / 2, hd + hdd * t,
                      kd + kdd * t);
    };
    const double power_W = (at(e) - at(-e)) / (2 * e);
    const LegAngles tau =
        leg.torque_Nm({float(h), float(k)}, {float(hd), float(kd)}, {float(hdd), float(kdd)});
    CAPTURE(h, k, hd, kd, hdd, kdd);
    // Torques of some 100 Nm in float, times speeds of up to 8 rad/s.
    REQUIRE(tau.hip_rad * hd + tau.knee_rad * kd == Approx(power_W).margin(2e-3));
  }
}

TEST_CASE("Each drive's friction is fed forward by its own speed, both signs") {
  const LegModelSettings m;
  const LegDynamics leg(m), ideal(frictionless());
  for (const float sign : {-1.0f, 1.0f}) {
    const LegAngles q{0.5f, -1.2f}, v{sign * 2.0f, -sign * 1.0f};
    const LegAngles with = leg.torque_Nm(q, v, {}), without = ideal.torque_Nm(q, v, {});
    CHECK(with.hip_rad - without.hip_rad ==
          Approx(sign * (4.8 * 2.0 / 2.05 + 0.5 * 2.0)).epsilon(1e-5));
    CHECK(with.knee_rad - without.knee_rad ==
          Approx(-sign * (4.8 * 1.0 / 1.05 + 0.5 * 1.0)).epsilon(1e-5));
    CHECK(leg.friction_doubt_Nm(v).hip_rad == Approx(4.8 * 0.05 / 2.05));
    CHECK(leg.friction_doubt_Nm({}).knee_rad == 4.8f);
  }
}

TEST_CASE("Friction feed-forward is odd, smooth at zero and right at speed") {
  CHECK(smooth_friction_Nm(2.0f, 0.0f, 0.0f) == 0.0f);
  CHECK(smooth_friction_Nm(2.0f, 0.0f, 0.05f) == Approx(1.0f));
  CHECK(smooth_friction_Nm(2.0f, 0.0f, 5.0f) == Approx(2.0f).epsilon(0.011));
  CHECK(smooth_friction_Nm(2.0f, 0.0f, -5.0f) == -smooth_friction_Nm(2.0f, 0.0f, 5.0f));
  CHECK(smooth_friction_Nm(0.0f, 0.5f, -3.0f) == -1.5f);
  CHECK(smooth_friction_Nm(2.0f, 0.5f, 0.05f) == Approx(1.025f));
}
