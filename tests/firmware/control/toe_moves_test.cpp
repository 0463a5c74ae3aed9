// The toe's set point: never a jump, whatever is ordered when, though planning takes some ticks.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "firmware/control/toe_opening.h"

using namespace hoof::firmware::control;

namespace {

/// Steps the toe and requires speed, acceleration and jerk within the settings. The command's
/// speed is the set point's own.
class Watched {
 public:
  explicit Watched(const ToeSettings& s) : settings_(s), toe(s, kTick_s) { toe.start(0.0f); }

  void tick() {
    JointState at;
    at.position_rad = toe.set_point_rad();
    const JointCommand c = toe.step(at);
    const double v = c.velocity_rad_s, a = (v - velocity_) / kTick_s;
    REQUIRE(std::abs(v) <= settings_.speed_rad_s * 1.0001);
    REQUIRE(c.position_rad - position_ ==
            Approx((v + velocity_) / 2 * kTick_s).margin(4e-7));  // digits of 0.7
    // Differences of float speeds: 1.2e-7 * 2 / 1 ms.
    REQUIRE(std::abs(a) <= settings_.acceleration_rad_s2 * 1.0001 + 1e-3);
    REQUIRE(std::abs(a - acceleration_) <= settings_.jerk_rad_s3 * kTick_s * 1.001 + 2e-3);
    position_ = c.position_rad, velocity_ = v, acceleration_ = a;
  }

  double velocity() const { return velocity_; }

 private:
  ToeSettings settings_;
  double position_ = 0.0, velocity_ = 0.0, acceleration_ = 0.0;

 public:
  ToeOpening toe;
};

}  // namespace

TEST_CASE(
    "Orders at any moment, also while one is being planned: within speed, acceleration, jerk") {
  INFO("seed 61");
  std::mt19937 random(61);
  std::uniform_real_distribution<float> angle(0.0f, 0.69f);
  std::uniform_int_distribution<int> ticks(1, 400), few(1, 8), choice(0, 5);
  const ToeSettings settings;
  Watched watched(settings);
  for (int n = 0; n < 2000; ++n) {
    const int kind = choice(random);
    const float target_rad = angle(random);
    CAPTURE(n, kind, target_rad);
    if (kind == 0) {
      watched.toe.halt();
    } else {
      watched.toe.move_to(target_rad);
    }
    for (int i = kind < 3 ? few(random) : ticks(random); i > 0; --i) watched.tick();
  }
  watched.toe.move_to(0.25f);
  for (int i = 0; i < 1500; ++i) watched.tick();
  CHECK(watched.toe.set_point_rad() == 0.25f);
  CHECK_FALSE(watched.toe.moving());
}

TEST_CASE("A move begins some ticks after its order, and counts as moving from the first") {
  ToeOpening toe({}, kTick_s);
  toe.start(0.0f);
  for (int round = 0; round < 3; ++round) {
    const float from_rad = toe.set_point_rad();
    toe.move_to(from_rad + 0.1f);
    int waited = 0;
    toe.step({});
    while (toe.set_point_rad() == from_rad && waited < 50) {
      CHECK(toe.moving());
      toe.step({});
      ++waited;
    }
    using Planner = hoof::firmware::trajectory::Planner<float, 1>;
    const int units = Planner::usual_units(1, hoof::firmware::trajectory::Synchronisation::kTime);
    CHECK(waited >= units / kPlanningUnitsPerTick - 1);
    CHECK(waited <= units / kPlanningUnitsPerTick + 1);
    for (int i = 0; i < 600; ++i) toe.step({});
    CHECK_FALSE(toe.moving());
    CHECK(toe.set_point_rad() == from_rad + 0.1f);
  }
}

TEST_CASE("Halted, the set point comes to rest at once within the limits, and stays there") {
  const ToeSettings settings;
  for (int at = 1; at < 420; at += 3) {
    Watched watched(settings);
    watched.toe.move_to(0.6f);
    for (int i = 0; i < at; ++i) watched.tick();
    const float there_rad = watched.toe.set_point_rad();
    const bool was_moving = watched.toe.moving();
    watched.toe.halt();
    int ticks = 0;
    while (watched.toe.moving() && ticks < 1000) watched.tick(), ++ticks;
    CAPTURE(at, there_rad);
    // From 2 rad/s: v/a + a/j = 120 ms and the acceleration it may still have (20 ms), and 5 ticks.
    CHECK(ticks <= 150);
    CHECK(watched.velocity() == Approx(0.0).margin(1e-6));
    CHECK(watched.toe.target_rad() == watched.toe.set_point_rad());
    // v^2 / 2a + v a / 2j, a tick's rest, and a tick more of planning.
    CHECK(watched.toe.set_point_rad() - there_rad < 0.173f);
    const float rest_rad = watched.toe.set_point_rad();
    if (was_moving && at < 200) CHECK(rest_rad < 0.6f);
    for (int i = 0; i < 100; ++i) watched.tick();
    CHECK(watched.toe.set_point_rad() == rest_rad);
    watched.toe.move_to(0.1f);
    for (int i = 0; i < 1000; ++i) watched.tick();
    CHECK(watched.toe.set_point_rad() == 0.1f);
  }
}

TEST_CASE("No move takes longer than the bound that is told, and the bound is not idle") {
  INFO("seed 62");
  std::mt19937 random(62);
  std::uniform_real_distribution<float> way(0.001f, 0.69f), log_speed(-3.0f, 2.0f),
      log_acceleration(-0.7f, 5.3f), log_jerk(2.3f, 9.9f);
  double closest = 1e9;
  for (int n = 0; n < 2000; ++n) {
    ToeSettings settings;
    settings.speed_rad_s = std::exp(log_speed(random));
    settings.acceleration_rad_s2 = std::exp(log_acceleration(random));
    settings.jerk_rad_s3 = std::exp(log_jerk(random));
    const float way_rad = way(random);
    ToeOpening toe(settings, kTick_s);
    toe.start(0.0f);
    toe.step({});  // a plan to stay is under way, and is finished first
    toe.move_to(way_rad);
    int ticks = 0;
    JointState at;
    do {
      at.position_rad = toe.set_point_rad();
      toe.step(at);
      ++ticks;
    } while (toe.moving() && ticks < 100000);
    const double bound_s = toe.longest_move_s(way_rad), took_s = ticks * 1e-3;
    CAPTURE(settings.speed_rad_s, settings.acceleration_rad_s2, settings.jerk_rad_s3, way_rad);
    REQUIRE(took_s <= bound_s + 1e-6);
    closest = std::min(closest, bound_s - took_s);
  }
  CHECK(closest < 0.003);
}
