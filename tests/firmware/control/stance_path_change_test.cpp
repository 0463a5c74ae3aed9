// The stance path when it is ordered anew on the run, and where it starts.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "firmware/control/leg_motion.h"
#include "firmware/control/stance_path.h"

using namespace hoof::firmware::control;

namespace {

constexpr float kDt_s = 0.001f;

/// Watches that nothing jumps: place by speed, speed by acceleration, and acceleration by what the
/// sharpest ramp and the ellipse bend.
class Continuity {
 public:
  explicit Continuity(float fastest_Hz) : fastest_Hz_(fastest_Hz) {}

  void check(const StancePath& path) {
    const PathPoint now = path.point();
    REQUIRE(path.rate_Hz() >= 0.0f);
    if (known_) {
      const double w = 2.0 * M_PI * fastest_Hz_, a = 0.10, dt = kDt_s;
      REQUIRE(distance(now.position_m, last_.position_m) <= a * w * dt * 1.3);
      // The acceleration's change per tick: a (w^3 + 3 w w' + w''), with w' up to 1.5 w / T,
      // w'' up to (6 + 6) w / T^2 where a ramp brakes and begins, T = 0.4 / fastest; half as much
      // again for a rate above its target meanwhile.
      const double T = 0.4 / fastest_Hz_;
      const double bend = a * (w * w * w + 4.5 * w * w / T + 12.0 * w / (T * T)) * dt * 1.5;
      CAPTURE(path.rate_Hz(), path.phase_cycles());
      REQUIRE(distance(now.acceleration_m_s2, last_.acceleration_m_s2) <= bend);
      const PlaneVector mean{(now.acceleration_m_s2.x + last_.acceleration_m_s2.x) / 2,
                             (now.acceleration_m_s2.z + last_.acceleration_m_s2.z) / 2};
      const PlaneVector gained{now.velocity_m_s.x - last_.velocity_m_s.x,
                               now.velocity_m_s.z - last_.velocity_m_s.z};
      REQUIRE(gained.x == Approx(mean.x * dt).margin(bend * dt));
      REQUIRE(gained.z == Approx(mean.z * dt).margin(bend * dt));
    }
    last_ = now;
    known_ = true;
  }

 private:
  static double distance(PlaneVector a, PlaneVector b) {
    return std::hypot(double(a.x) - b.x, double(a.z) - b.z);
  }

  float fastest_Hz_;
  PathPoint last_;
  bool known_ = false;
};

}  // namespace

TEST_CASE("A frequency ordered at any moment of a change jumps neither speed nor acceleration") {
  struct Case {
    float first_Hz, then_Hz;
  };
  for (const Case& c : {Case{2.0f, 0.0f}, Case{2.0f, 0.3f}, Case{0.3f, 2.0f}, Case{1.12f, 0.45f}}) {
    for (int at = 1; at < 1500; at += 7) {
      CAPTURE(c.first_Hz, c.then_Hz, at);
      StancePath path{PathSettings{}};
      Continuity watch(2.0f);
      watch.check(path);
      path.set_frequency(c.first_Hz);
      for (int i = 0; i < at; ++i) path.advance(kDt_s), watch.check(path);
      path.set_frequency(c.then_Hz);
      for (int i = 0; i < 1500; ++i) path.advance(kDt_s), watch.check(path);
      REQUIRE(path.rate_Hz() == c.then_Hz);
      REQUIRE(path.at_rest() == (c.then_Hz == 0.0f));
    }
  }
}

TEST_CASE("Orders at random, many within one change: never backwards, never above by a fifth") {
  INFO("seed 51");
  std::mt19937 random(51);
  std::uniform_real_distribution<float> frequency(0.0f, 2.0f);
  std::uniform_int_distribution<int> ticks(1, 300), choice(0, 3);
  StancePath path{PathSettings{}};
  Continuity watch(2.0f);
  float highest_Hz = 0.0f;
  for (int n = 0; n < 3000; ++n) {
    const int kind = choice(random);
    const float target_Hz = kind == 0 ? 0.0f : kind == 1 ? 2.0f : frequency(random);
    path.set_frequency(target_Hz);
    CAPTURE(n, target_Hz);
    for (int i = ticks(random); i > 0; --i) {
      path.advance(kDt_s);
      watch.check(path);
      highest_Hz = std::max(highest_Hz, path.rate_Hz());
    }
  }
  CHECK(highest_Hz >= 2.0f);
  CHECK(highest_Hz < 2.0f * 1.2f);
}

TEST_CASE("Told to stop in the tick after the start, the path stands within 0.4 periods") {
  StancePath path{PathSettings{}};
  path.set_frequency(1.0f);
  path.advance(kDt_s);
  path.set_frequency(0.0f);
  for (int i = 0; i < 401; ++i) path.advance(kDt_s);
  CHECK(path.at_rest());
  CHECK(path.phase_cycles() == Approx(0.75).margin(1e-3));
}

TEST_CASE("Reset to any phase, in any number of cycles, at rest; then played from there") {
  struct Case {
    float given, phase;
  };
  for (const Case& c : {Case{0.0f, 0.0f}, Case{0.25f, 0.25f}, Case{0.5f, 0.5f}, Case{1.0f, 0.0f},
                        Case{2.75f, 0.75f}, Case{-0.25f, 0.75f}, Case{-1e-9f, 0.0f}}) {
    StancePath path{PathSettings{}};
    path.set_frequency(1.0f);
    for (int i = 0; i < 130; ++i) path.advance(kDt_s);
    path.reset(c.given);
    CHECK(path.phase_cycles() == c.phase);
    CHECK(path.at_rest());
    CHECK(path.point().velocity_m_s.x == 0.0f);
    CHECK(path.point().acceleration_m_s2.z == 0.0f);
    path.set_frequency(1.0f);
    for (int i = 0; i < 400; ++i) path.advance(kDt_s);
    const float after = c.phase + 0.2f;
    CHECK(path.phase_cycles() == Approx(after - std::floor(after)).margin(1e-3));
  }
}

TEST_CASE("A walk starts at the phase of the settings, after a stop as well") {
  Settings settings;
  settings.path.start_phase_cycles = 0.5f;
  LegMotion leg(settings, kTick_s);
  for (int turn = 0; turn < 2; ++turn) {
    leg.start({0.3f, -1.8f});
    leg.go_to_path();
    for (int i = 0; i < 3000; ++i) leg.step();
    REQUIRE(leg.on_path());
    const PlaneVector foot = leg.kinematics().foot_m(leg.set_point_rad());
    CHECK(foot.x == Approx(-0.10).margin(1e-6));  // the rear
    CHECK(foot.z == Approx(-0.495).margin(1e-6));
    leg.set_frequency(1.0f);
    for (int i = 0; i < 777; ++i) leg.step();
  }
}

TEST_CASE("Above the sand for so long: against a search of the path, tick by tick") {
  for (const float centre_m : {-0.05f, -0.02f, 0.0f, 0.005f, 0.03f, 0.05f}) {
    PathSettings settings;
    settings.centre_above_sand_m = centre_m;
    for (const float rate_Hz : {0.3f, 1.12f, 2.0f}) {
      for (const float time_s : {0.001f, 0.05f, 0.15f, 0.4f, 5.0f}) {
        StancePath path(settings);
        path.set_frequency(rate_Hz);
        while (path.rate_Hz() < rate_Hz) path.advance(kDt_s);
        int said = 0, disagreed = 0, ticks = int(1.0f / rate_Hz / kDt_s);
        for (int i = 0; i < ticks; ++i) {
          path.advance(kDt_s);
          bool above = true;
          for (double t = 0.0; above && t <= time_s && t * rate_Hz <= 1.0; t += 5e-4) {
            const double phase = double(path.phase_cycles()) + rate_Hz * t;
            above = centre_m - 0.04 * std::sin(2.0 * M_PI * phase) > 0.0;
          }
          // A path wholly above the sand is called so until it passes its deepest point only.
          if (centre_m > 0.04f) {
            if (path.above_sand_for(time_s) && !above) ++disagreed;
          } else if (path.above_sand_for(time_s) != above) {
            ++disagreed;
          }
          said += path.above_sand_for(time_s) ? 1 : 0;
        }
        CAPTURE(centre_m, rate_Hz, time_s);
        CHECK(disagreed <= 2);  // a tick at each end of the window
        if (centre_m < -0.04f) CHECK(said == 0);
      }
    }
  }
}
