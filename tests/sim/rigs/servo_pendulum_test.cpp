// The servo pendulum against closed forms.
#include "sim/rigs/servo_pendulum.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "sim/effects/effect.h"

using namespace hoof::sim;

namespace {

struct Bench {
  PendulumSettings settings;
  std::vector<double> time_s, goal_rad, torque_Nm, enable;
  PendulumStart start;
  double step_s = 1e-3;

  explicit Bench(double span_s, double sample_s = 0.005) {
    settings.law = PendulumLaw::kTorque;
    settings.payload_mass_kg = 0.5;
    settings.payload_length_m = 0.2;
    settings.arm_mass_kg = 0.06;
    settings.armature_kg_m2 = 0.004;
    settings.torque_limit_Nm = 5;
    for (double t = 0; t < span_s; t += sample_s) {
      time_s.push_back(t);
      goal_rad.push_back(0);
      torque_Nm.push_back(0);
    }
  }

  PendulumTrace run(const std::vector<JointEffect*>& effects = {}) const {
    PendulumInputs inputs;
    inputs.time_s = time_s;
    inputs.position_goal_rad = goal_rad;
    inputs.torque_Nm = torque_Nm;
    inputs.enable = enable;
    PendulumTrace trace;
    simulate_pendulum(settings, inputs, effects, start, {}, step_s, trace);
    return trace;
  }
  double inertia() const { return settings.link_inertia_kg_m2() + settings.armature_kg_m2; }
};

std::unique_ptr<JointEffect> make(const char* name, std::vector<double> values) {
  return find_effect(name)->make_joint(values);
}

}  // namespace

TEST_CASE("a small free swing has the period of the closed form") {
  Bench bench(10);
  bench.start.position_rad = 0.01;
  const PendulumTrace trace = bench.run();
  const double rate = std::sqrt(bench.settings.gravity_torque_Nm() / bench.inertia());
  double worst = 0;
  for (std::size_t i = 0; i < trace.position_rad.size(); ++i) {
    worst =
        std::max(worst, std::abs(trace.position_rad[i] - 0.01 * std::cos(rate * bench.time_s[i])));
  }
  // Second order: (rate h)^2 / 24 of phase a radian, ten seconds of 6.6 rad/s; and the swing's own
  // amplitude, 0.01^2 / 16 of its period.
  CHECK(worst < 0.01 * 66 * (std::pow(rate * bench.step_s, 2) / 24 + 1e-4 / 16 + 1e-4));
}

TEST_CASE("friction stops a swing after the way of the closed form and holds it there") {
  for (const double sign : {1.0, -1.0}) {
    CAPTURE(sign);
    Bench bench(3);
    bench.settings.gravity_m_s2 = 0;
    bench.settings.coulomb_Nm = 0.05;
    bench.start.velocity_rad_s = sign * 2;
    const PendulumTrace trace = bench.run();
    const double way = bench.inertia() * 4 / (2 * 0.05);
    CHECK(trace.position_rad.back() == Approx(sign * way).epsilon(1e-3));
    CHECK(trace.velocity_rad_s.back() == 0.0);
  }
}

TEST_CASE("friction holds any torque up to its own and lets go above") {
  for (const double sign : {1.0, -1.0}) {
    CAPTURE(sign);
    Bench bench(2);
    bench.settings.coulomb_Nm = 0.1;
    bench.settings.gravity_m_s2 = 0;
    for (double& t : bench.torque_Nm) t = sign * 0.0999;
    CHECK(bench.run().position_rad.back() == 0.0);
    for (double& t : bench.torque_Nm) t = sign * 0.11;
    const double reached = 0.5 * 0.01 / bench.inertia() * std::pow(bench.time_s.back(), 2);
    CHECK(bench.run().position_rad.back() == Approx(sign * reached).epsilon(1e-6));
  }
}

TEST_CASE("without friction the energy of a large swing stays") {
  Bench bench(10);
  bench.start.position_rad = 2.5;
  const PendulumTrace trace = bench.run();
  const double most = bench.settings.gravity_torque_Nm() * (1 - std::cos(2.5));
  for (std::size_t i = 0; i < trace.position_rad.size(); ++i) {
    const double energy =
        0.5 * bench.inertia() * std::pow(trace.velocity_rad_s[i], 2) +
        bench.settings.gravity_torque_Nm() * (1 - std::cos(trace.position_rad[i]));
    CHECK(energy == Approx(most).epsilon(2e-3));  // between steps by a cubic; 2e-4 at the steps
  }
}

TEST_CASE("an impedance loop ends where gravity and spring balance") {
  Bench bench(6);
  bench.settings.law = PendulumLaw::kImpedance;
  bench.settings.kp_Nm_rad = 4;
  bench.settings.kd_Nm_s_rad = 0.4;
  bench.settings.control_period_s = 0.002;
  for (double& goal : bench.goal_rad) goal = 1.0;
  const PendulumTrace trace = bench.run();
  const double q = trace.position_rad.back();
  CHECK(4 * (1 - q) == Approx(bench.settings.gravity_torque_Nm() * std::sin(q)).epsilon(1e-6));
  CHECK(trace.torque_Nm.back() == Approx(4 * (1 - q)).epsilon(1e-9));
  CHECK(trace.torque_Nm.front() == Approx(4.0));
}

TEST_CASE("a gap lets the motor turn alone by its width") {
  Bench bench(4);
  bench.settings.coulomb_Nm = 0.0;
  bench.settings.law = PendulumLaw::kImpedance;
  bench.settings.kp_Nm_rad = 100;
  bench.settings.kd_Nm_s_rad = 2;
  bench.settings.torque_limit_Nm = 20;
  // The goal goes slowly from one side to the other; the load hangs on one end of the gap, then on
  // the other, so that torque stays near zero while the motor crosses it.
  for (std::size_t i = 0; i < bench.time_s.size(); ++i) {
    bench.goal_rad[i] = -0.2 + 0.1 * bench.time_s[i];
  }
  bench.start.position_rad = -0.2;
  const auto gap = make("backlash", {0.06});
  const PendulumTrace with = bench.run({gap.get()});
  const PendulumTrace without = bench.run();
  double slack = 0, none = 0;
  for (std::size_t i = 0; i + 1 < bench.time_s.size(); ++i) {
    const double way = with.position_rad[i + 1] - with.position_rad[i];
    if (std::abs(with.torque_Nm[i]) < 0.01) slack += way;
    if (std::abs(without.torque_Nm[i]) < 0.01) none += way;
  }
  // 0.01 Nm of gravity are 0.02 rad more, seen without a gap too.
  CHECK(slack - none == Approx(0.06).margin(0.012));
}

TEST_CASE("a soft joint gives way by the load over its stiffness") {
  Bench bench(40);  // its swing is damped by 2 % of critical only
  bench.settings.law = PendulumLaw::kImpedance;
  bench.settings.kp_Nm_rad = 200;
  bench.settings.kd_Nm_s_rad = 2;
  bench.settings.viscous_Nm_s_rad = 0.05;
  bench.settings.torque_limit_Nm = 20;
  for (double& goal : bench.goal_rad) goal = 1.0;
  bench.start.position_rad = 0.9;
  const auto soft = make("joint_compliance", {8.0});
  const PendulumTrace trace = bench.run({soft.get()});
  // The link hangs lower than the motor by torque / stiffness: gravity acts at that angle.
  const double torque = trace.torque_Nm.back();
  const double link = trace.position_rad.back() - torque / 8.0;
  CHECK(torque == Approx(bench.settings.gravity_torque_Nm() * std::sin(link)).epsilon(0.01));
}

TEST_CASE("an effect of no size changes nothing to speak of") {
  struct Nothing {
    const char* name;
    std::vector<double> values;
  };
  Bench bench(3);
  bench.settings.law = PendulumLaw::kImpedance;
  bench.settings.kp_Nm_rad = 5;
  bench.settings.kd_Nm_s_rad = 0.3;
  bench.settings.coulomb_Nm = 0.03;
  for (std::size_t i = 0; i < bench.time_s.size(); ++i) {
    bench.goal_rad[i] = std::sin(3 * bench.time_s[i]);
  }
  const PendulumTrace plain = bench.run();
  for (const Nothing& n : {Nothing{"stribeck_friction", {0, 0.1}},
                           {"load_dependent_friction", {0}},
                           {"directional_friction", {0}},
                           {"cogging_torque", {0, 6, 1}},
                           {"torque_ceiling", {1000}},
                           {"supply_sag", {0}},
                           {"thermal_derating", {0, 5}},
                           {"transport_delay", {0}},
                           {"encoder_eccentricity", {0, 1}},
                           {"parasitic_spring", {0, 1}},
                           {"frame_loss", {0, 5}}}) {
    CAPTURE(n.name);
    const auto effect = make(n.name, n.values);
    CHECK(bench.run({effect.get()}).position_rad == plain.position_rad);
  }
}

TEST_CASE("a late goal is the same motion, later") {
  Bench bench(4);
  bench.settings.law = PendulumLaw::kImpedance;
  bench.settings.kp_Nm_rad = 5;
  bench.settings.kd_Nm_s_rad = 0.3;
  bench.settings.control_period_s = 0.001;
  for (std::size_t i = 0; i < bench.time_s.size(); ++i) {
    bench.goal_rad[i] = bench.time_s[i] < 1 ? 0 : 0.5;
  }
  const PendulumTrace plain = bench.run();
  const auto late = make("transport_delay", {0.05});  // ten samples
  const PendulumTrace delayed = bench.run({late.get()});
  for (std::size_t i = 10; i < bench.time_s.size(); ++i) {
    CHECK(delayed.position_rad[i] == Approx(plain.position_rad[i - 10]).margin(1e-9));
  }
}
