#include "tools/conceal/servo_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools::conceal {
namespace {

ServoMachine draw_machine(const PlanWish& wish, RandomStream& random) {
  ServoMachine m;
  m.law = wish.law;
  m.payload_mass_kg = random.log_uniform(0.15, 2.0);
  m.payload_length_m = random.uniform(0.08, 0.3);
  m.arm_mass_kg = m.payload_mass_kg * random.uniform(0.03, 0.25);
  m.armature_kgm2 = m.link_inertia_kgm2() * random.log_uniform(wish.two_masses ? 0.2 : 0.05, 0.6);
  const double weight_Nm = m.gravity_torque_Nm();
  m.coulomb_Nm = weight_Nm * random.log_uniform(0.04, 0.2);
  m.viscous_Nms_rad = weight_Nm * random.log_uniform(0.02, 0.12) / 3.0;
  m.control_period_s = random.pick({0.001, 0.001, 0.002, 0.004, 0.005});
  m.kt_Nm_A = weight_Nm * random.uniform(0.5, 1.5);
  m.supply_V = random.pick({7.4, 11.1, 12.0, 14.8, 24.0});
  m.resistance_ohm = m.kt_Nm_A * m.supply_V / (weight_Nm * random.uniform(1.8, 4.0));
  m.torque_limit_Nm = weight_Nm * random.uniform(2.0, 4.0);
  return m;
}

/// Rate of the position loop in rad/s: as high as control period and armature bear it.
double draw_loop_rate(const PlanWish& wish, const ServoMachine& m, RandomStream& random) {
  double rate = wish.stiff ? random.uniform(60.0, 140.0) : random.log_uniform(9.0, 28.0);
  rate = std::min(rate, 0.25 / m.control_period_s);
  if (wish.two_masses) {
    rate = std::min(rate, 0.3 * m.armature_kgm2 / m.inertia_kgm2() / m.control_period_s);
  }
  return rate;
}

void draw_gains(const PlanWish& wish, ServoPlan& plan, RandomStream& random) {
  ServoMachine& m = plan.machine;
  if (wish.law == DriveLaw::kImpedance) {
    plan.loop_rate_rad_s = draw_loop_rate(wish, m, random);
    m.kd_Nms_rad = 2.0 * random.uniform(0.5, 1.0) * m.inertia_kgm2() * plan.loop_rate_rad_s;
  }
  const bool several = random.chance(0.4), velocity_goal = random.chance(0.6);
  plan.torque_ff = wish.law == DriveLaw::kImpedance && random.chance(0.2);
  const double feed_gravity = m.gravity_torque_Nm() * random.uniform(0.8, 1.2);
  const double feed_inertia = m.inertia_kgm2() * random.uniform(0.7, 1.2);
  const double kp = m.inertia_kgm2() * plan.loop_rate_rad_s * plan.loop_rate_rad_s;
  const double duty = random.pick({200.0, 400.0, 800.0, 1600.0});
  for (ServoExercise& e : plan.exercises) {
    if (wish.law == DriveLaw::kImpedance) {
      e.gain = several ? kp * random.uniform(0.7, 1.0) : kp;
      e.velocity_goal = velocity_goal;
      if (plan.torque_ff) {
        e.feed_gravity_Nm = feed_gravity;
        e.feed_inertia_kgm2 = feed_inertia;
      }
    } else if (wish.law == DriveLaw::kDuty) {
      e.gain = several ? random.pick({200.0, 400.0, 800.0, 1600.0}) : duty;
    }
  }
}

/// Waves of torque, about which the joint swings below the level: open loop.
GoalPath draw_torque_path(int kind, const ServoMachine& m, double duration_s,
                          RandomStream& random) {
  const double weight_Nm = m.gravity_torque_Nm();
  GoalPath path;
  path.fade_in_s = 0.8;
  if (kind % 3 == 0) {
    path.sines.push_back({random.uniform(0.6, 0.9), random.uniform(0.12, 0.3), 0.0});
    path.sines.push_back({random.uniform(0.05, 0.2), random.uniform(0.6, 2.0), 1.0});
  } else if (kind % 3 == 1) {
    for (int i = 0; i < 4; ++i) {
      path.sines.push_back(
          {random.uniform(0.15, 0.45), random.log_uniform(0.15, 3.0), random.uniform(0.0, 6.28)});
    }
  } else {
    path.offset = random.uniform(-0.3, 0.3);
    path.chirps.push_back({random.uniform(0.5, 0.8), 0.15, random.uniform(1.0, 3.0), duration_s});
  }
  path.scale(weight_Nm);
  path.offset *= weight_Nm;
  return path;
}

std::vector<double> draw_times(double duration_s, RandomStream& random) {
  const bool uneven = random.chance(0.35);
  const double step_s = random.chance(0.8) ? 0.005 : random.pick({0.004, 0.008, 0.01});
  std::vector<double> times;
  double t_s = 0.0;
  while (t_s < duration_s) {
    times.push_back(t_s);
    if (!uneven) {
      t_s = double(times.size()) * step_s;
    } else {
      t_s += step_s * random.uniform(0.75, 1.3);
      if (random.chance(0.002)) t_s += random.uniform(0.01, 0.05);
      t_s = 1e-6 * std::round(1e6 * t_s);
    }
  }
  return times;
}

void draw_exercises(const PlanWish& wish, ServoPlan& plan, RandomStream& random) {
  const int count = random.integer(4, 6);
  std::vector<int> kinds = {2, 3, 4, 5, 6};
  random.shuffle(kinds);
  kinds.insert(kinds.begin(), {0, 1});  // always one slow and one quick
  const double encoder_step_rad =
      random.chance(0.3) ? 2.0 * std::numbers::pi / random.pick({4096.0, 16384.0}) : 0.0;
  for (int i = 0; i < count; ++i) {
    ServoExercise e;
    const double duration_s = random.uniform(6.0, 9.0);
    e.lead_in_s = !wish.start_cold && random.chance(0.25)
                      ? 0.02 * std::round(random.uniform(0.5, 2.0) / 0.02)
                      : 0.0;
    const double path_s = duration_s + e.lead_in_s;
    e.goal = wish.law == DriveLaw::kTorque
                 ? draw_torque_path(i, plan.machine, path_s, random)
                 : draw_position_path(kinds[std::size_t(i)], path_s, random, e.disable_at_s);
    e.times_s = draw_times(duration_s, random);
    e.encoder_step_rad = encoder_step_rad;
    e.loss_seed = random.bits();
    plan.exercises.push_back(e);
  }
  const int held_out = count > 4 ? random.integer(1, 2) : 1;
  plan.holdout.assign(std::size_t(count), false);
  for (int i = 0; i < held_out; ++i) plan.holdout[std::size_t(count - 1 - i)] = true;
}

void draw_supply(const PlanWish& wish, ServoPlan& plan, RandomStream& random) {
  plan.supply_channel = wish.law == DriveLaw::kDuty && !wish.plain_supply && random.chance(0.4);
  if (!plan.supply_channel) return;
  for (ServoExercise& e : plan.exercises) {
    e.supply_wander.offset = -plan.machine.supply_V * random.uniform(0.0, 0.04);
    e.supply_wander.sines.push_back({plan.machine.supply_V * random.uniform(0.01, 0.04),
                                     random.uniform(0.05, 0.6), random.uniform(0.0, 6.28)});
  }
}

void draw_channels(const PlanWish& wish, ServoPlan& plan, RandomStream& random) {
  const double step = plan.exercises.front().encoder_step_rad;
  const double position_noise =
      step > 0.0 ? step / std::sqrt(12.0) : random.log_uniform(wish.stiff ? 5e-4 : 2e-4, 2e-3);
  plan.predicted.push_back({"position", &ServoSignals::position, position_noise});
  if (random.chance(0.5)) {
    plan.predicted.push_back(
        {"velocity", &ServoSignals::velocity, random.log_uniform(0.005, 0.05)});
  }
  const bool impedance = wish.law == DriveLaw::kImpedance;
  const bool torque = impedance && (wish.stiff || random.chance(0.75));
  const bool current = wish.law != DriveLaw::kTorque && random.chance(impedance ? 0.3 : 0.5);
  if (torque) plan.predicted.push_back({"torque", &ServoSignals::torque, 0.0});
  if (current) plan.predicted.push_back({"current", &ServoSignals::current, 0.0});
  plan.effort_snr_db = random.uniform(10.0, 40.0);
  plan.temperature = random.chance(0.15);
  plan.noise_given = random.chance(0.5);
  plan.degrees = random.chance(0.15);
  plan.own_names = random.chance(0.3);
  plan.missing_share = random.chance(0.1) ? 0.01 : 0.0;
  plan.first_time_s = random.chance(0.2) ? random.uniform(0.0, 50.0) : 0.0;
  plan.first_time_s = 1e-3 * std::round(1e3 * plan.first_time_s);
}

void draw_doubts(const PlanWish& wish, ServoPlan& plan, RandomStream& random) {
  using M = ServoMachine;
  const auto doubt = [&](const char* key, double M::*field, double least, double most) {
    const double truth = plan.machine.*field;
    const double error = random.sign() * random.uniform(least, most);
    const double sigma = truth * random.uniform(0.7, 1.0) * most;
    plan.doubts.push_back(
        {key, field, wish.right_parameters ? truth : truth * (1.0 + error), sigma});
  };
  if (random.chance(0.4)) doubt("payload_mass", &M::payload_mass_kg, 0.03, 0.1);
  doubt("arm_mass", &M::arm_mass_kg, 0.1, 0.3);
  doubt("armature", &M::armature_kgm2, 0.1, 0.3);
  doubt("coulomb", &M::coulomb_Nm, 0.1, 0.3);
  doubt("viscous", &M::viscous_Nms_rad, 0.1, 0.3);
  bool current = wish.law == DriveLaw::kDuty;
  for (const ChannelNoise& c : plan.predicted) current = current || c.channel == "current";
  if (current) doubt("kt", &M::kt_Nm_A, 0.1, 0.25);
  if (wish.law == DriveLaw::kDuty) doubt("resistance", &M::resistance_ohm, 0.1, 0.25);
}

}  // namespace

ServoPlan draw_servo_plan(const PlanWish& wish, RandomStream& random) {
  ServoPlan plan;
  plan.machine = draw_machine(wish, random);
  draw_exercises(wish, plan, random);
  draw_gains(wish, plan, random);
  draw_supply(wish, plan, random);
  draw_channels(wish, plan, random);
  draw_doubts(wish, plan, random);
  for (std::size_t i = 0; i < plan.exercises.size(); ++i) {
    plan.files.push_back("recording_" + std::to_string(i + 1) + ".csv");
  }
  return plan;
}

void set_effort_noise(ServoPlan& plan, const std::vector<ServoSignals>& clean) {
  for (ChannelNoise& c : plan.predicted) {
    if (c.channel != "torque" && c.channel != "current") continue;
    double sum = 0.0, count = 0.0;
    for (const ServoSignals& s : clean) {
      for (const double v : s.*c.signal) sum += v * v;
      count += double((s.*c.signal).size());
    }
    c.sigma = std::sqrt(sum / count) * std::pow(10.0, -plan.effort_snr_db / 20.0);
  }
}

std::vector<ServoSignals> run_plan(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                                   double step_s) {
  std::vector<ServoSignals> signals;
  for (const ServoExercise& e : plan.exercises) {
    signals.push_back(run_servo(plan.machine, hidden, e, {}, step_s));
  }
  return signals;
}

}  // namespace hoof::tools::conceal
