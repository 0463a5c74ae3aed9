#include "firmware/control/stance_path.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::firmware::control;

namespace {
constexpr float kDt_s = 0.001f;
}

TEST_CASE("The path starts at its top, at rest, and stays there") {
  StancePath path{PathSettings{}};
  for (int i = 0; i < 100; ++i) path.advance(kDt_s);
  CHECK(path.phase_cycles() == 0.75f);
  CHECK(path.at_rest());
  CHECK(path.point().position_m.x == Approx(0.0).margin(1e-7));
  CHECK(path.point().position_m.z == Approx(-0.5 + 0.005 + 0.04).margin(1e-6));
  CHECK(path.point().velocity_m_s.x == 0.0f);
}

TEST_CASE("Every point lies on the ellipse; the foot goes back through the lower half") {
  StancePath path{PathSettings{}};
  path.set_frequency(1.12f);
  float deepest = 0.0f;
  for (int i = 0; i < 5000; ++i) {
    path.advance(kDt_s);
    const PathPoint p = path.point();
    const double x = p.position_m.x / 0.10;
    const double z = (p.position_m.z + 0.495) / 0.04;
    REQUIRE(x * x + z * z == Approx(1.0).margin(1e-5));
    if (z < -0.1) REQUIRE(p.velocity_m_s.x < 0.0f);
    if (z > 0.1 && i > 100) REQUIRE(p.velocity_m_s.x > 0.0f);
    deepest = std::min(deepest, p.position_m.z + 0.5f);
  }
  CHECK(deepest == Approx(-0.035).margin(1e-6));  // 35 mm into the sand
}

TEST_CASE("Speeds and accelerations are the derivatives of the place, ramps included") {
  StancePath path{PathSettings{}};
  path.set_frequency(1.12f);
  PathPoint before = path.point();
  PathPoint now = before;
  for (int i = 0; i < 3000; ++i) {
    if (i == 1500) path.set_frequency(0.0f);
    path.advance(kDt_s);
    const PathPoint next = path.point();
    // Central differences; their error is (dt^2/6) * third derivative < 1e-4, that of the
    // float positions 6e-8 / 1e-3, and of the rate changing in steps dt/2 * acceleration.
    const double vx = (next.position_m.x - before.position_m.x) / 2e-3;
    const double vz = (next.position_m.z - before.position_m.z) / 2e-3;
    REQUIRE(now.velocity_m_s.x == Approx(vx).margin(4e-3));
    REQUIRE(now.velocity_m_s.z == Approx(vz).margin(4e-3));
    const double ax = (next.velocity_m_s.x - before.velocity_m_s.x) / 2e-3;
    const double az = (next.velocity_m_s.z - before.velocity_m_s.z) / 2e-3;
    // At the ends of a ramp the acceleration bends: a tick of its slope.
    REQUIRE(now.acceleration_m_s2.x == Approx(ax).margin(0.06));
    REQUIRE(now.acceleration_m_s2.z == Approx(az).margin(0.06));
    before = now;
    now = next;
  }
  CHECK(path.at_rest());
  CHECK(now.velocity_m_s.x == 0.0f);
}

TEST_CASE("Full speed is reached before the foot is down") {
  for (const float frequency_Hz : {0.2f, 0.45f, 1.12f, 2.0f}) {
    StancePath path{PathSettings{}};
    path.set_frequency(frequency_Hz);
    int ticks = 0;
    while (path.rate_Hz() < frequency_Hz && ticks < 10000) {
      path.advance(kDt_s);
      ++ticks;
    }
    CHECK(ticks == Approx(400.0 / frequency_Hz).margin(1.0));  // 0.4 periods
    CHECK(path.phase_cycles() == Approx(0.95).margin(0.005));  // a fifth of a cycle from the top
    CHECK(path.point().position_m.z > -0.5f);
  }
}

TEST_CASE("Phase neither drifts nor loses digits over an hour of gait") {
  StancePath path{PathSettings{}};
  path.set_frequency(1.0f);
  for (int i = 0; i < 3600 * 1000; ++i) path.advance(kDt_s);
  // 3600 cycles less the 0.2 of the ramp; each tick rounds by at most 2^-33 cycles, all alike.
  const double expected = 0.75 + 3600.0 - 0.2;
  CHECK(path.phase_cycles() == Approx(expected - std::floor(expected)).margin(1.5e-3));
}

TEST_CASE("Reset goes back to the top at rest") {
  StancePath path{PathSettings{}};
  path.set_frequency(1.0f);
  for (int i = 0; i < 700; ++i) path.advance(kDt_s);
  path.reset();
  CHECK(path.phase_cycles() == 0.75f);
  CHECK(path.rate_Hz() == 0.0f);
  path.set_frequency(1.0f);
  path.advance(kDt_s);
  CHECK(path.rate_Hz() > 0.0f);
}
