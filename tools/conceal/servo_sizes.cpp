#include "tools/conceal/servo_sizes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace hoof::tools::conceal {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Draw {
  double share;
  const ServoPlan& plan;
  const ServoScale& scale;
  RandomStream& random;

  double torque() const { return share * scale.torque_rms; }
  double angle() const { return random.uniform(-0.5 * kTurn, 0.5 * kTurn); }
  double weight() const { return plan.machine.gravity_torque_Nm(); }
  /// A position loop rings where something is late by more than its own time.
  double late(double wish_s) const {
    return plan.loop_rate_rad_s > 0.0 ? std::min(wish_s, 0.35 / plan.loop_rate_rad_s) : wish_s;
  }
};

using Parameters = std::vector<EffectParameter>;
using Drawing = std::map<std::string, std::function<Parameters(const Draw&)>>;

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[std::size_t(q * double(sorted.size() - 1))];
}

const Drawing& friction_and_gear() {
  static const Drawing drawing = {
      {"stribeck_friction",
       [](const Draw& d) -> Parameters {
         return {{"extra", d.torque(), "Nm"}, {"speed", d.random.log_uniform(0.06, 0.7), "rad/s"}};
       }},
      {"load_dependent_friction",
       [](const Draw& d) -> Parameters {
         return {{"coefficient", std::clamp(0.55 * d.share, 0.02, 0.35), "1"}};
       }},
      {"directional_friction",
       [](const Draw& d) -> Parameters {
         const double size = std::clamp(d.torque() / d.plan.machine.coulomb_Nm, 0.12, 0.7);
         return {{"asymmetry", d.random.sign() * size, "1"}};
       }},
      {"backlash",
       [](const Draw& d) -> Parameters {
         return {{"gap", 0.2 * d.share * d.random.uniform(0.7, 1.4), "rad"}};
       }},
      {"joint_compliance",
       [](const Draw& d) -> Parameters {
         return {{"stiffness", d.scale.torque_rms / (0.25 * d.share), "Nm/rad"}};
       }},
      {"cogging_torque",
       [](const Draw& d) -> Parameters {
         const double order = d.random.pick({4., 5., 6., 7., 8., 10., 12., 14., 16., 20., 24.});
         return {{"amplitude", 1.414 * d.torque(), "Nm"},
                 {"order", order, "1/rev"},
                 {"phase", d.angle(), "rad", kTurn}};
       }},
      {"encoder_eccentricity",
       [](const Draw& d) -> Parameters {
         return {{"amplitude", 0.15 * d.share, "rad"}, {"phase", d.angle(), "rad", kTurn}};
       }},
      {"parasitic_spring",
       [](const Draw& d) -> Parameters {
         const double rest = d.random.uniform(-0.8, 0.8);
         return {{"stiffness", d.torque() / std::hypot(rest, d.scale.position_rms), "Nm/rad"},
                 {"rest", rest, "rad"}};
       }},
  };
  return drawing;
}

const Drawing& drive_and_bus() {
  static const Drawing drawing = {
      {"torque_ceiling",
       [](const Draw& d) -> Parameters {
         return {{"ceiling", quantile(d.scale.torque_sizes, 1.0 - 0.7 * d.share), "Nm"}};
       }},
      {"supply_sag",
       [](const Draw& d) -> Parameters {
         return {{"resistance", d.plan.machine.resistance_ohm * 1.5 * d.share, "ohm"}};
       }},
      {"thermal_derating",
       [](const Draw& d) -> Parameters {
         return {{"fraction", std::clamp(d.share, 0.05, 0.4), "1"},
                 {"time_constant", d.random.log_uniform(0.8, 6.0), "s"},
                 {"_reference", d.scale.current_rms, "A"}};
       }},
      {"actuator_lag",
       [](const Draw& d) -> Parameters {
         return {{"time_constant", d.late(0.16 * d.share), "s"}};
       }},
      {"transport_delay",
       [](const Draw& d) -> Parameters {
         return {{"delay", 1e-4 * std::round(1e4 * 0.2 * d.share), "s"}};
       }},
      {"frame_loss",
       [](const Draw& d) -> Parameters {
         const double period_s = d.plan.machine.control_period_s;
         const double burst = std::max(2.0, std::round(d.random.uniform(0.04, 0.16) / period_s));
         const double lost = std::clamp(d.share, 0.08, 0.4);
         return {{"probability", lost / (burst * (1.0 - lost)), "1"}, {"burst", burst, "1"}};
       }},
  };
  return drawing;
}

const Drawing& unlisted_of_the_joint() {
  static const Drawing drawing = {
      {"quadratic_drag",
       [](const Draw& d) -> Parameters {
         return {{"coefficient", 2.0 * d.torque() / (d.scale.velocity_rms * d.scale.fastest),
                  "Nm s2/rad2"}};
       }},
      {"rough_spot_friction",
       [](const Draw& d) -> Parameters {
         return {
             {"share", std::clamp(1.4 * d.torque() / d.plan.machine.coulomb_Nm, 0.4, 0.95), "1"},
             {"order", d.random.pick({2., 3., 4., 5., 6.}), "1/rev"},
             {"phase", d.angle(), "rad", kTurn}};
       }},
      {"presliding_bristles",
       [](const Draw& d) -> Parameters {
         return {{"slip", 0.02 + 0.25 * d.share, "rad"}};
       }},
      {"hardening_spring",
       [](const Draw& d) -> Parameters {
         const double reach = std::max(d.scale.highest, 0.5);
         return {{"coefficient", 2.5 * d.torque() / (reach * reach * reach), "Nm/rad3"},
                 {"rest", d.random.uniform(-0.2, 0.2), "rad"}};
       }},
      {"drifting_friction",
       [](const Draw& d) -> Parameters {
         const double growth = d.torque() / d.plan.machine.coulomb_Nm;
         return {{"growth", std::clamp(2.0 * growth, 0.4, 2.0), "1"}, {"time", 6.0, "s"}};
       }},
      {"end_stop",
       [](const Draw& d) -> Parameters {
         return {{"at", d.scale.highest * d.random.uniform(0.55, 0.8), "rad"},
                 {"stiffness", 30.0 * d.share * d.weight(), "Nm/rad"}};
       }},
      {"magnetic_detent",
       [](const Draw& d) -> Parameters {
         return {{"amplitude", 2.5 * d.torque(), "Nm"},
                 {"at", d.random.uniform(-0.6, 0.6) * d.scale.highest, "rad"},
                 {"width", d.random.uniform(0.06, 0.15), "rad"}};
       }},
  };
  return drawing;
}

const Drawing& unlisted_of_load_and_motor() {
  static const Drawing drawing = {
      {"torque_dead_zone",
       [](const Draw& d) -> Parameters {
         return {{"width", 1.2 * d.torque(), "Nm"}};
       }},
      {"sliding_payload",
       [](const Draw& d) -> Parameters {
         return {{"at", d.random.uniform(2.5, 5.0), "s"},
                 {"by", 1.2 * d.share * d.plan.machine.payload_length_m, "m"}};
       }},
      {"dropped_payload",
       [](const Draw& d) -> Parameters {
         return {{"at", d.random.uniform(2.5, 5.0), "s"},
                 {"by", std::min(1.2 * d.share, 0.6) * d.plan.machine.payload_mass_kg, "kg"}};
       }},
      {"periodic_disturbance",
       [](const Draw& d) -> Parameters {
         return {{"amplitude", 1.414 * d.torque(), "Nm"},
                 {"frequency", d.random.log_uniform(0.7, 8.0), "Hz"}};
       }},
      {"uneven_motor",
       [](const Draw& d) -> Parameters {
         return {{"share", std::min(1.3 * d.share, 0.5), "1"}};
       }},
      {"speed_loss",
       [](const Draw& d) -> Parameters {
         return {{"share", std::clamp(2.5 * d.share, 0.3, 0.9), "1"},
                 {"speed", 0.7 * d.scale.fastest, "rad/s"}};
       }},
      {"torque_ripple",
       [](const Draw& d) -> Parameters {
         return {{"share", std::min(1.6 * d.share, 0.7), "1"},
                 {"order", d.random.pick({3., 4., 6., 8., 12.}), "1/rev"}};
       }},
      {"swinging_load",
       [](const Draw& d) -> Parameters {
         return {{"share", std::clamp(1.5 * d.share, 0.1, 0.6), "1"},
                 {"frequency", d.random.uniform(2.0, 6.0), "Hz"}};
       }},
      {"late_sensor",
       [](const Draw& d) -> Parameters {
         return {{"delay", d.late(0.12 * d.share), "s"}};
       }},
  };
  return drawing;
}

std::vector<std::string> names_of(std::initializer_list<const Drawing*> drawings) {
  std::vector<std::string> names;
  for (const Drawing* drawing : drawings) {
    for (const auto& [name, draw] : *drawing) names.push_back(name);
  }
  return names;
}

bool has(const std::vector<std::string>& effects, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&effects](const char* name) {
    return std::find(effects.begin(), effects.end(), name) != effects.end();
  });
}

}  // namespace

const std::vector<std::string>& listed_servo_effects() {
  static const std::vector<std::string> names = names_of({&friction_and_gear(), &drive_and_bus()});
  return names;
}

const std::vector<std::string>& unlisted_servo_effects() {
  static const std::vector<std::string> names =
      names_of({&unlisted_of_the_joint(), &unlisted_of_load_and_motor()});
  return names;
}

ServoScale scale_of(const ServoPlan& plan, const std::vector<ServoSignals>& clean) {
  ServoScale scale;
  double count = 0.0, torque2 = 0.0, position2 = 0.0, velocity2 = 0.0, current2 = 0.0;
  for (const ServoSignals& s : clean) {
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      scale.torque_sizes.push_back(std::abs(s.torque[i]));
      scale.torque_mean_size += std::abs(s.torque[i]);
      torque2 += s.torque[i] * s.torque[i];
      position2 += s.position[i] * s.position[i];
      velocity2 += s.velocity[i] * s.velocity[i];
      scale.fastest = std::max(scale.fastest, std::abs(s.velocity[i]));
      scale.highest = std::max(scale.highest, std::abs(s.position[i]));
    }
    const double n = double(s.position.size());
    current2 += plan.machine.law == DriveLaw::kTorque ? 0.0 : s.square_current_mean * n;
    count += n;
  }
  std::sort(scale.torque_sizes.begin(), scale.torque_sizes.end());
  scale.torque_rms = std::sqrt(torque2 / count);
  scale.torque_mean_size /= count;
  scale.position_rms = std::sqrt(position2 / count);
  scale.velocity_rms = std::sqrt(velocity2 / count);
  scale.current_rms = plan.machine.law == DriveLaw::kTorque
                          ? scale.torque_rms / plan.machine.kt_Nm_A
                          : std::sqrt(current2 / count);
  return scale;
}

PlanWish wish_for(const std::vector<std::string>& effects, bool stiff, RandomStream& random) {
  PlanWish wish;
  wish.stiff = stiff;
  const double luck = random.uniform();
  wish.law = luck < 0.5 || stiff ? DriveLaw::kImpedance
             : luck < 0.8        ? DriveLaw::kDuty
                                 : DriveLaw::kTorque;
  const bool duty_only = has(effects, {"supply_sag"});
  const bool needs_goal = has(effects, {"transport_delay", "frame_loss"});
  if (duty_only) wish.law = DriveLaw::kDuty;
  if (needs_goal && wish.law == DriveLaw::kTorque) wish.law = DriveLaw::kImpedance;
  if (wish.law != DriveLaw::kImpedance) wish.stiff = false;
  wish.plain_supply = duty_only;
  wish.two_masses = has(effects, {"backlash", "joint_compliance"});
  wish.start_cold = has(effects, {"thermal_derating"});
  return wish;
}

HiddenEffect draw_servo_effect(const std::string& name, double share, const ServoPlan& plan,
                               const ServoScale& scale, RandomStream& random) {
  const Draw draw{share, plan, scale, random};
  HiddenEffect effect{name, true, {}};
  for (const Drawing* drawing : {&friction_and_gear(), &drive_and_bus()}) {
    if (drawing->contains(name)) effect.parameters = drawing->at(name)(draw);
  }
  if (!effect.parameters.empty()) return effect;
  effect.listed = false;
  for (const Drawing* drawing : {&unlisted_of_the_joint(), &unlisted_of_load_and_motor()}) {
    if (drawing->contains(name)) effect.parameters = drawing->at(name)(draw);
  }
  return effect;
}

}  // namespace hoof::tools::conceal
