// Recordings of a servo pendulum in which two effects look alike.
//
// supply_sag, thermal_derating   moved so slowly that current, supply and winding are steady at
//                                each load: both take torque in proportion to the cube of it
// parasitic_spring, cogging      small motion about one angle: both are a torque and its slope
// directional, stribeck          one way at one speed: both are friction of one size
//
// That no test can tell them apart is checked: the rival is fitted to what is seen.

#include "tools/conceal/servo_alike.h"

#include <cmath>

#include "tools/conceal/rival_fit.h"
#include "tools/conceal/servo_case.h"
#include "tools/run/errors.h"

namespace hoof::tools::conceal {
namespace {

constexpr int kMostDraws = 60;
constexpr double kSameForAnyTest = 5.0;

void keep_doubts(ServoPlan& plan, std::initializer_list<const char*> exact) {
  std::erase_if(plan.doubts, [&exact](const DoubtfulParameter& d) {
    for (const char* key : exact) {
      if (d.key == key) return true;
    }
    return false;
  });
}

void plain_exercise(ServoExercise& e) {
  e.goal = {};
  e.lead_in_s = 0.0;
  e.disable_at_s = std::numeric_limits<double>::infinity();
}

void slow_loads(ServoPlan& plan, RandomStream& random) {
  for (ServoExercise& e : plan.exercises) {
    plain_exercise(e);
    e.goal.moves.push_back({0.0, e.times_s.back(), random.sign() * random.uniform(1.3, 1.9), true});
    e.gain = plan.exercises[0].gain;
  }
}

void about_one_angle(ServoPlan& plan, RandomStream& random) {
  const double middle = random.sign() * random.uniform(0.2, 0.9);
  for (ServoExercise& e : plan.exercises) {
    plain_exercise(e);
    e.goal.offset = middle;
    e.goal.fade_in_s = 0.5;
    for (int i = 0; i < 3; ++i) {
      e.goal.sines.push_back(
          {random.uniform(0.01, 0.03), random.log_uniform(0.3, 2.0), random.uniform(0.0, 6.28)});
    }
  }
  keep_doubts(plan, {"payload_mass"});
}

void one_way(ServoPlan& plan, RandomStream& random) {
  const double speed_rad_s = random.uniform(0.2, 0.3), side = random.sign();
  for (ServoExercise& e : plan.exercises) {
    plain_exercise(e);
    e.lead_in_s = 1.0;
    const double whole_s = e.times_s.back() + 2.0;
    e.goal.offset = -0.5 * side * speed_rad_s * whole_s;
    e.goal.moves.push_back({0.0, whole_s, side * speed_rad_s * whole_s, false});
  }
  keep_doubts(plan, {"payload_mass", "coulomb", "viscous"});
}

ServoPlan draw_plan(const CaseRequest& request, RandomStream& random) {
  const std::string& first = request.alike[0];
  PlanWish wish;
  wish.law = first == "supply_sag" ? DriveLaw::kDuty : DriveLaw::kImpedance;
  wish.plain_supply = wish.start_cold = true;
  wish.stiff = first == "directional_friction";
  ServoPlan plan = draw_servo_plan(wish, random);
  plan.exercises.resize(4);
  plan.files.resize(4);
  plan.holdout = {false, false, false, true};
  if (first == "supply_sag") {
    slow_loads(plan, random);
    // A winding that is warm takes more current for the same torque, a supply that sags does not.
    std::erase_if(plan.predicted, [](const ChannelNoise& c) { return c.channel != "position"; });
    plan.predicted[0].sigma = std::max(plan.predicted[0].sigma, random.uniform(1.2e-3, 2e-3));
    for (ServoExercise& e : plan.exercises) e.encoder_step_rad = 0.0;
  }
  if (first == "parasitic_spring") about_one_angle(plan, random);
  if (first == "directional_friction") one_way(plan, random);
  return plan;
}

/// The numbers of an effect that make it like its rival: a winding that warms at once, few turns
/// of cogging, friction that grows on the way that is gone.
void adapt(const ServoPlan& plan, HiddenEffect& effect) {
  // Only the first order of what is lost is the same.
  if (effect.name == "supply_sag") {
    double& resistance = effect.find("resistance").value;
    resistance = std::min(resistance, 0.22 * plan.machine.resistance_ohm);
  }
  if (effect.name == "thermal_derating") effect.find("time_constant").value = 0.08;
  if (effect.name == "cogging_torque") effect.find("order").value = 2.0;
  if (effect.name == "stribeck_friction") effect.find("speed").value = 0.5;
  if (effect.name == "directional_friction") {
    double& asymmetry = effect.find("asymmetry").value;
    asymmetry = std::copysign(asymmetry, plan.exercises[0].goal.rate(2.0));
  }
}

/// Winding against supply: r i^2 R / U^2 of the torque is lost, or fraction i^2 over its mean.
void match(const ServoPlan& plan, const ServoScale& scale, const HiddenEffect& hidden,
           HiddenEffect& rival) {
  if (rival.name != "thermal_derating") return;
  const ServoMachine& m = plan.machine;
  const double rms_duty = m.resistance_ohm * scale.current_rms / m.supply_V;
  rival.find("fraction").value = rms_duty * rms_duty * hidden.at("resistance") / m.resistance_ohm;
}

bool alike(const ServoPlan& plan, const HiddenInServo& hidden, const CaseRequest& request,
           const ServoScale& scale, RandomStream random) {
  for (const std::string& name : request.alike) {
    if (name == request.effects[0]) continue;
    double least = 1e30;
    for (int start = 0; start < 3 && least > kSameForAnyTest; ++start) {
      HiddenEffect rival = draw_servo_effect(name, random.uniform(0.1, 0.3), plan, scale, random);
      adapt(plan, rival);
      match(plan, scale, hidden.effects[0], rival);
      least = std::min(least, rival_misfit(plan, hidden.effects, rival));
    }
    if (least > kSameForAnyTest) return false;
  }
  return true;
}

}  // namespace

CaseRequest servo_alike_request(std::size_t index) {
  CaseRequest request;
  request.kind = "not_decidable";
  switch (index % 4) {
    case 0:
      request.alike = {"supply_sag", "thermal_derating"};
      break;
    case 1:
      request.alike = {"parasitic_spring", "cogging_torque"};
      break;
    default:
      request.alike = {"directional_friction", "stribeck_friction"};
      break;
  }
  request.effects = {request.alike[index % 4 == 3 ? 1 : 0]};
  return request;
}

CaseData make_servo_alike_case(const std::string& name, const CaseRequest& request,
                               const RandomStream& random) {
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const RandomStream stream = random.branch(std::uint64_t(draw));
    RandomStream planning = stream.branch(0);
    ServoPlan plan = draw_plan(request, planning);
    HiddenInServo hidden;
    hidden.signals = run_plan(plan, {});
    if (!all_sane(hidden.signals)) continue;
    set_effort_noise(plan, hidden.signals);
    const ServoScale scale = scale_of(plan, hidden.signals);
    if (!hide_in_servo(request, plan, scale, stream.branch(2), hidden,
                       [&plan](HiddenEffect& e) { adapt(plan, e); })) {
      continue;
    }
    if (!alike(plan, hidden, request, scale, stream.branch(3))) continue;
    return finish_servo_case(name, request, plan, hidden, stream);
  }
  throw CannotFinish(name + ": no recordings were found in which the effects look alike");
}

}  // namespace hoof::tools::conceal
