// Drive, sensor and bus of the examiner's plant against closed forms.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/tools/conceal/servo_bench.h"
#include "tools/conceal/servo_plant.h"

using namespace hoof::tests;
using namespace hoof::tools::conceal;

namespace {

double swing_of(const std::vector<double>& values) {
  const auto [low, high] =
      std::minmax_element(values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return *high - *low;
}

/// Held by friction that nothing overcomes: what the drive does at standstill.
ServoMachine jammed(DriveLaw law) {
  ServoMachine m = free_pendulum();
  m.law = law;
  m.coulomb_Nm = 1e3;
  return m;
}

}  // namespace

TEST_CASE("a lag makes a sine of torque smaller by 1 / sqrt(1 + (w T)^2)") {
  ServoMachine m = free_pendulum();
  m.gravity_m_s2 = 0.0;
  const double rate = 2.0 * std::numbers::pi * 5.0;
  ServoExercise e = idle(4.0, 0.001);
  e.goal.sines = {{0.2, 5.0, 0.5 * std::numbers::pi}};
  const double without = swing_of(run_servo(m, {}, e, {true, 0.0, 0.0}).velocity);
  CHECK(without == Approx(2.0 * 0.2 / rate / m.inertia_kgm2()).epsilon(1e-3));
  const auto lag = hidden("actuator_lag", {{"time_constant", 0.04, "s"}});
  const double with = swing_of(run_servo(m, {lag}, e, {true, 0.0, 0.0}).velocity);
  CHECK(with == Approx(without / std::hypot(1.0, rate * 0.04)).epsilon(1e-3));
}

TEST_CASE("a late goal is the same motion later") {
  const ServoMachine m = held_pendulum();
  ServoExercise e = idle(3.0);
  e.gain = 15.0;
  e.velocity_goal = true;
  e.goal.moves = {{0.5, 0.5, 0.8, true}};
  const auto now = run_servo(m, {}, e);
  const auto late = run_servo(m, {hidden("transport_delay", {{"delay", 0.05, "s"}})}, e);
  for (std::size_t i = 10; i < now.position.size(); ++i) {
    CHECK(std::abs(late.position[i] - now.position[i - 10]) < 1e-9);
    CHECK(late.position_goal[i] == now.position_goal[i]);  // recorded as commanded
  }
}

TEST_CASE("the impedance law: torque by error, speed and limit; no torque when disabled") {
  ServoMachine m = jammed(DriveLaw::kImpedance);
  m.torque_limit_Nm = 2.0;
  ServoExercise e = idle(2.0);
  e.gain = 10.0;
  e.goal.offset = 0.1;
  e.goal.moves = {{0.0, 1.0, 0.8, true}};
  e.disable_at_s = 1.5;
  const ServoSignals s = run_servo(m, {}, e, {true, 0.02, 0.0});
  CHECK(s.torque.front() == Approx(10.0 * 0.08));
  CHECK(s.torque[250] == 2.0);
  CHECK(s.torque[350] == 0.0);
  CHECK(s.current.front() == Approx(10.0 * 0.08 / m.kt_Nm_A));
  CHECK(s.enable[299] == 1.0);
  CHECK(s.enable[301] == 0.0);
}

TEST_CASE("the duty law at standstill, and a supply that sags") {
  const ServoMachine m = jammed(DriveLaw::kDuty);
  for (const double error : {0.2, -0.2}) {
    ServoExercise e = idle(0.5);
    e.gain = 800.0;
    e.goal.offset = error;
    const double duty = 800.0 * m.counts_per_rad * error / 256.0 / 885.0;
    const ServoSignals s = run_servo(m, {}, e, {true, 0.0, 0.0});
    CHECK(s.current.back() == Approx(duty * m.supply_V / m.resistance_ohm).epsilon(1e-9));
    const auto sag = hidden("supply_sag", {{"resistance", 0.9, "ohm"}});
    const double current = run_servo(m, {sag}, e, {true, 0.0, 0.0}).current.back();
    // The contract's own words: supply = supply - resistance |current duty|.
    CHECK(current == Approx(duty * (m.supply_V - 0.9 * std::abs(current * duty)) / m.resistance_ohm)
                         .epsilon(1e-9));
    CHECK(std::abs(current) < std::abs(s.current.back()));
  }
}

TEST_CASE("heat follows the square of the current and takes torque in proportion") {
  const ServoMachine m = jammed(DriveLaw::kImpedance);
  ServoExercise e = idle(6.0);
  e.gain = 10.0;
  e.goal.offset = 0.05;
  const double current = 0.5 / m.kt_Nm_A;
  const auto hot = hidden(
      "thermal_derating",
      {{"fraction", 0.1, "1"}, {"time_constant", 2.0, "s"}, {"_reference", 0.5 * current, "A"}});
  ServoPlant plant(m, {hot}, e, 1e-4);
  plant.start_with(0.0, 0.0);
  plant.advance_to(3.0);
  const double heat = 4.0 * (1.0 - std::exp(-1.5));  // twice the current it is measured by
  CHECK(plant.moment().heat == Approx(heat).epsilon(1e-6));
  CHECK(plant.moment().delivered_Nm == Approx(0.5 * (1.0 - 0.1 * heat)).epsilon(1e-6));
}

TEST_CASE("a bent encoder is read by recorder and drive alike") {
  const auto bent =
      hidden("encoder_eccentricity", {{"amplitude", 0.03, "rad"}, {"phase", 0.7, "rad"}});
  const ServoMachine m = held_pendulum();
  ServoExercise e = idle(6.0);
  e.gain = 20.0;
  e.goal.offset = 0.8;
  ServoPlant plant(m, {bent}, e, 1e-4);
  plant.start_at_rest();
  plant.advance_to(6.0);
  const double q = plant.position();
  CHECK(plant.measured_position() == Approx(q + 0.03 * std::sin(q + 0.7)).epsilon(1e-12));
  CHECK(plant.commanded_torque() == Approx(20.0 * (0.8 - plant.measured_position())).margin(1e-6));
}

TEST_CASE("goals are lost as often and as long as said") {
  const ServoMachine m = held_pendulum();
  ServoExercise e = idle(200.0, 0.01);
  e.gain = 20.0;
  e.goal.sines = {{0.5, 0.5, 0.0}};
  e.loss_seed = 5;
  const auto loss = hidden("frame_loss", {{"probability", 0.01, "1"}, {"burst", 30.0, "1"}});
  const ServoSignals s = run_servo(m, {loss}, e, {}, 1e-3);
  double lost = 0.0;
  for (const double off : s.influence[0]) lost += off > 0.0 ? 1.0 : 0.0;
  lost /= double(s.influence[0].size());
  // About 1500 bursts of 30 periods: 0.3 / 1.3 of the time, deviation 0.006.
  CHECK(lost == Approx(0.3 / 1.3).margin(0.025));
}

TEST_CASE("a ceiling clips what the motor makes, not what was commanded") {
  const ServoMachine m = jammed(DriveLaw::kImpedance);
  ServoExercise e = idle(0.5);
  e.gain = 10.0;
  e.goal.offset = 0.1;
  ServoPlant plant(m, {hidden("torque_ceiling", {{"ceiling", 0.6, "Nm"}})}, e, 1e-4);
  plant.start_with(0.0, 0.0);
  plant.advance_to(0.4);
  CHECK(plant.commanded_torque() == Approx(1.0));
  CHECK(plant.moment().delivered_Nm == Approx(0.6));
}
