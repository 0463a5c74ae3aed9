#include "firmware/control/toe_opening.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/firmware/control/joint_plant.h"

using namespace hoof::firmware::control;
using test::JointPlant;

namespace {

constexpr double kDegree_rad = 3.14159265358979 / 180.0;

/// Little friction, so that closed forms show.
ToeSettings light() {
  ToeSettings settings;
  settings.friction_Nm = 0.05f;
  settings.viscous_friction_Nm_s_rad = 0.0f;
  return settings;
}

struct Bench {
  ToeSettings settings;
  ToeOpening toe;
  JointPlant plant;

  explicit Bench(ToeSettings s = light()) : settings(s), toe(s, kTick_s) {
    plant.friction_Nm = s.friction_Nm;
    plant.viscous_Nm_s_rad = s.viscous_friction_Nm_s_rad;
    toe.start(0.0f);
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) plant.run(toe.step(plant.state()));
  }
};

}  // namespace

TEST_CASE("The toes open to any angle within speed and acceleration, and say when they are there") {
  for (const float degrees : {5.0f, 20.0f, 40.0f}) {
    Bench bench;
    const float goal_rad = degrees * static_cast<float>(kDegree_rad);
    bench.toe.move_to(goal_rad);
    float previous_rad = 0.0f, previous_rad_s = 0.0f;
    int ticks = 0;
    double lag_rad = 0.0;
    do {
      bench.run(1);
      lag_rad = std::max(lag_rad, std::abs(bench.plant.q_rad - bench.toe.set_point_rad()));
      const float speed_rad_s = (bench.toe.set_point_rad() - previous_rad) / kTick_s;
      REQUIRE(std::abs(speed_rad_s) <= bench.settings.speed_rad_s * 1.001f);
      // Differences of float positions near 0.7 rad: 6e-8 / 1e-6 = 0.06 rad/s2.
      REQUIRE(std::abs(speed_rad_s - previous_rad_s) / kTick_s <=
              bench.settings.acceleration_rad_s2 + 0.5f);
      previous_rad = bench.toe.set_point_rad();
      previous_rad_s = speed_rad_s;
    } while (bench.toe.moving() && ++ticks < 2000);
    CHECK(ticks < 1000);
    // The set point is half a tick ahead on average: 2 rad/s * 0.5 ms. Without the feed-forward of
    // inertia 0.24 / 250 = 1 mrad more.
    CHECK(lag_rad < 1.3e-3);
    CHECK(bench.toe.set_point_rad() == goal_rad);
    bench.run(300);
    // Friction of 0.05 Nm leaves 0.05 / 250 rad.
    CHECK(bench.plant.q_rad == Approx(goal_rad).margin(2.1e-4));
  }
}

TEST_CASE("A change of mind on the way goes to the new angle without a jump") {
  Bench bench;
  bench.toe.move_to(0.6f);
  bench.run(150);
  const float there_rad = bench.toe.set_point_rad();
  REQUIRE(there_rad > 0.05f);
  bench.toe.move_to(0.1f);
  bench.run(1);
  CHECK(bench.toe.set_point_rad() == Approx(there_rad).margin(0.0021));  // at most 2 rad/s
  bench.run(1500);
  CHECK(bench.plant.q_rad == Approx(0.1).margin(2.1e-4));
}

TEST_CASE("Under load the deflection is load over stiffness: less than half a degree at 1.5 Nm") {
  for (const double load_Nm : {1.5, -1.5}) {
    Bench bench;
    bench.toe.move_to(0.5236f);
    bench.run(1000);
    bench.plant.load_Nm = load_Nm;
    bench.run(1000);
    const double deflection_rad = bench.plant.q_rad - 0.5236;
    // Friction may keep the joint up to 0.05 / 250 rad away.
    CHECK(deflection_rad == Approx(load_Nm / 250.0).margin(2.1e-4));
    CHECK(std::abs(deflection_rad) < 0.5 * kDegree_rad);
  }
}

TEST_CASE("Half the stiffness gives twice the deflection; none lets the sand move the toes") {
  ToeSettings half = light();
  half.kp_Nm_rad *= 0.5f;
  ToeSettings none = light();
  none.kp_Nm_rad = 0.0f;
  double deflection_rad[2] = {};
  const ToeSettings both[] = {half, none};
  for (int i = 0; i < 2; ++i) {
    Bench bench(both[i]);
    bench.toe.move_to(0.5236f);
    bench.run(1000);
    const double before_rad = bench.plant.q_rad;
    CHECK(before_rad == Approx(0.5236).margin(0.02));  // also by speed and feed-forward alone
    bench.plant.load_Nm = -1.5;
    bench.run(500);
    deflection_rad[i] = bench.plant.q_rad - before_rad;
  }
  CHECK(deflection_rad[0] == Approx(-2.0 * 1.5 / 250.0).margin(8e-4));
  CHECK(deflection_rad[1] < -5.0 * kDegree_rad);
}

TEST_CASE("The toe settles without ringing") {
  Bench bench;
  bench.plant.load_Nm = 1.5;
  bench.run(1000);
  bench.plant.load_Nm = 0.0;
  double lowest_rad = 0.0;
  for (int i = 0; i < 200; ++i) {
    bench.run(1);
    lowest_rad = std::min(lowest_rad, bench.plant.q_rad);
  }
  // Damping ratio 0.7 overshoots by 4.6 % of the 6 mrad.
  CHECK(lowest_rad > -0.06 * 1.5 / 250.0);
}

TEST_CASE("A jammed toe is noticed; the sand's load and a free move are not a jam") {
  Bench jam;
  jam.plant.stop_rad = 1e9;
  jam.toe.move_to(0.4f);
  JointState stuck;
  stuck.received = true;
  int ticks = 0;
  while (!jam.toe.jammed() && ticks < 2000) {
    const JointCommand c = jam.toe.step(stuck);
    stuck.torque_Nm = predicted_torque_Nm(c, stuck);
    ++ticks;
  }
  CHECK(ticks < 500);
  CHECK(ticks > 200);  // the jam time

  Bench free;
  free.toe.move_to(0.6981f);
  free.plant.load_Nm = -6.0;  // four times what sand does, and above the torque of a jam
  for (int i = 0; i < 2000; ++i) {
    free.run(1);
    REQUIRE_FALSE(free.toe.jammed());
  }
}
