// The examiner's plant against closed forms of pendulum, friction, gap and spring.

#include "tools/conceal/servo_plant.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/tools/conceal/servo_bench.h"

using namespace hoof::tests;
using namespace hoof::tools::conceal;

TEST_CASE("a small swing has the period of a pendulum, both ways") {
  const ServoMachine m = free_pendulum();
  const double period_s =
      2.0 * std::numbers::pi * std::sqrt(m.inertia_kgm2() / m.gravity_torque_Nm());
  for (const double from : {0.02, -0.02}) {
    const ServoSignals s = run_servo(m, {}, idle(8.0, 0.001), {true, from, 0.0});
    std::vector<double> crossings;
    for (std::size_t i = 1; i < s.position.size(); ++i) {
      if (s.position[i - 1] * s.position[i] >= 0.0) continue;
      const double share = s.position[i - 1] / (s.position[i - 1] - s.position[i]);
      crossings.push_back(0.001 * (double(i - 1) + share));
    }
    REQUIRE(crossings.size() > 5);
    const double mean_s =
        2.0 * (crossings.back() - crossings.front()) / double(crossings.size() - 1);
    // The circle's own correction is amplitude^2 / 16 = 2.5e-5.
    CHECK(mean_s == Approx(period_s * (1.0 + 0.02 * 0.02 / 16.0)).epsilon(1e-6));
  }
}

TEST_CASE("without friction the energy of a wide swing stays") {
  const ServoMachine m = free_pendulum();
  const ServoSignals s = run_servo(m, {}, idle(8.0), {true, 2.2, 0.0});
  const auto energy = [&](std::size_t i) {
    return 0.5 * m.inertia_kgm2() * s.velocity[i] * s.velocity[i] -
           m.gravity_torque_Nm() * std::cos(s.position[i]);
  };
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    CHECK(std::abs(energy(i) - energy(0)) < 1e-8 * m.gravity_torque_Nm());
  }
}

TEST_CASE("dry friction takes 2 Fc / G from each half swing, then holds for good") {
  ServoMachine m = free_pendulum();
  m.coulomb_Nm = 0.004 * m.gravity_torque_Nm();
  const ServoSignals s = run_servo(m, {}, idle(10.0, 0.001), {true, 0.05, 0.0});
  std::vector<double> turns;
  for (std::size_t i = 1; i + 1 < s.velocity.size(); ++i) {
    if (s.velocity[i - 1] * s.velocity[i] < 0.0) turns.push_back(std::abs(s.position[i]));
  }
  REQUIRE(turns.size() >= 4);
  // sin(q) is q to within q^2 / 6 = 4e-4.
  for (std::size_t i = 1; i < turns.size(); ++i) {
    CHECK(turns[i - 1] - turns[i] == Approx(0.008).epsilon(0.01));
  }
  CHECK(s.velocity.back() == 0.0);
  CHECK(std::abs(s.position.back()) <= 0.0041);
  CHECK(s.position[s.position.size() - 2000] == s.position.back());
}

TEST_CASE("at rest friction holds up to Coulomb and no further; Stribeck's part and load add") {
  ServoMachine m = free_pendulum();
  m.coulomb_Nm = 0.1;
  const auto moves = [&m](double torque_Nm, const std::vector<HiddenEffect>& effects) {
    ServoExercise e = idle(2.0);
    e.goal.offset = torque_Nm;
    return std::abs(run_servo(m, effects, e, {true, 0.0, 0.0}).position.back()) > 0.0;
  };
  for (const double side : {1.0, -1.0}) {
    CHECK_FALSE(moves(side * 0.0999, {}));
    CHECK(moves(side * 0.1001, {}));
    const auto stribeck =
        hidden("stribeck_friction", {{"extra", 0.05, "Nm"}, {"speed", 0.2, "rad/s"}});
    CHECK_FALSE(moves(side * 0.1499, {stribeck}));
    CHECK(moves(side * 0.1501, {stribeck}));
    // 0.1 + 0.25 t = t at t = 0.1333.
    const auto load = hidden("load_dependent_friction", {{"coefficient", 0.25, "1"}});
    CHECK_FALSE(moves(side * 0.1332, {load}));
    CHECK(moves(side * 0.1335, {load}));
  }
}

TEST_CASE("directional friction: steady speed differs by the way") {
  ServoMachine m = free_pendulum();
  m.gravity_m_s2 = 0.0;
  m.coulomb_Nm = 0.1;
  m.viscous_Nms_rad = 0.2;
  const auto uneven = hidden("directional_friction", {{"asymmetry", 0.4, "1"}});
  for (const double side : {1.0, -1.0}) {
    ServoExercise e = idle(1.8);
    e.goal.offset = side * 0.3;
    const ServoSignals s = run_servo(m, {uneven}, e, {true, -side * 1.0, 0.0});
    CHECK(s.velocity.back() == Approx(side * (0.3 - 0.1 * (1.0 + 0.4 * side)) / 0.2).epsilon(1e-4));
  }
}

TEST_CASE("in a gap gravity lays the link on its side of the motor; turning over takes the gap") {
  ServoMachine m = held_pendulum();
  m.armature_kgm2 = 0.01;
  m.viscous_Nms_rad = 0.05;
  const double gap = 0.04;
  const std::vector<HiddenEffect> effects = {hidden("backlash", {{"gap", gap, "rad"}})};
  ServoExercise e = idle(9.0);
  e.gain = 40.0;
  e.goal.offset = 0.6;
  e.goal.moves = {{2.0, 2.0, -1.2, true}};
  ServoPlant plant(m, effects, e, 1e-4);
  plant.start_at_rest();
  plant.advance_to(1.9);
  const double motor_before = plant.position(), link_before = plant.link_position();
  // The walls are hard: gravity presses 0.6 Nm into them by some ten microradians.
  CHECK(motor_before - link_before == Approx(0.5 * gap).epsilon(0.03));
  plant.advance_to(8.9);
  CHECK(plant.position() - plant.link_position() == Approx(-0.5 * gap).epsilon(0.03));
  const double motor_moved = motor_before - plant.position();
  CHECK(motor_moved - (link_before - plant.link_position()) == Approx(gap).epsilon(0.03));
}

TEST_CASE("within the gap a torque turns the motor's own inertia alone") {
  ServoMachine m = free_pendulum();
  m.gravity_m_s2 = 0.0;
  ServoExercise e = idle(0.05, 0.001);
  e.goal.offset = 0.02;
  ServoPlant plant(m, {hidden("backlash", {{"gap", 0.5, "rad"}})}, e, 1e-4);
  plant.start_with(0.0, 0.0);
  plant.advance_to(0.05);
  CHECK(plant.velocity() == Approx(0.02 / m.armature_kgm2 * 0.05).epsilon(1e-6));
  CHECK(plant.link_position() == 0.0);
}

TEST_CASE("a springy joint is bent by gravity over its stiffness") {
  const ServoMachine m = held_pendulum();
  for (const double goal : {1.1, -1.1}) {
    ServoExercise e = idle(6.0);
    e.gain = 30.0;
    e.goal.offset = goal;
    ServoPlant plant(m, {hidden("joint_compliance", {{"stiffness", 25.0, "Nm/rad"}})}, e, 1e-4);
    plant.start_at_rest();
    plant.advance_to(6.0);
    const double bent = plant.link_position() - plant.position();
    CHECK(bent ==
          Approx(-m.gravity_torque_Nm() * std::sin(plant.link_position()) / 25.0).epsilon(0.01));
  }
}

TEST_CASE("steps a quarter as long change a swing under all friction by nearly nothing") {
  ServoMachine m = held_pendulum();
  m.coulomb_Nm = 0.08;
  ServoExercise e = idle(4.0);
  e.gain = 12.0;
  e.goal.sines = {{0.8, 0.7, 0.0}, {0.2, 1.9, 1.0}};
  e.goal.fade_in_s = 0.5;
  const auto effects = {
      hidden("stribeck_friction", {{"extra", 0.06, "Nm"}, {"speed", 0.2, "rad/s"}})};
  const ServoSignals coarse = run_servo(m, effects, e, {}, 1e-4);
  const ServoSignals fine = run_servo(m, effects, e, {}, 2.5e-5);
  for (std::size_t i = 0; i < coarse.position.size(); ++i) {
    CHECK(std::abs(coarse.position[i] - fine.position[i]) < 2e-6);
  }
}
