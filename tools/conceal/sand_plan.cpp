#include "tools/conceal/sand_plan.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools::conceal {
namespace {

bool asks_for(const CaseRequest& request, const char* name) {
  return std::find(request.effects.begin(), request.effects.end(), name) != request.effects.end();
}

/// Down to `depth_m` and, where asked for, up a bit, down again, and a rest at the bottom.
SandPress draw_press(const CaseRequest& request, double width_m, double speed_m_s, bool cycles,
                     RandomStream& random) {
  SandPress press;
  press.disc = true;
  press.width_m = press.length_m = width_m;
  const double above_m = random.uniform(0.001, 0.004), depth_m = random.uniform(0.015, 0.03);
  press.start_height_m = random.uniform(0.06, 0.12);
  press.surface_height_m = press.start_height_m - above_m;
  const bool alike = request.kind == "not_decidable";
  double t_s = 0.0;
  const auto move = [&](double by_m, double speed) {
    press.travel.moves.push_back({t_s, std::abs(by_m) / speed, by_m, false});
    t_s += std::abs(by_m) / speed + 0.15;
  };
  if (alike) {
    // Recorded from motion to motion: the same speed all the way.
    move(above_m + depth_m + 2.0 * speed_m_s, speed_m_s);
    t_s = (above_m + depth_m) / speed_m_s;
  } else {
    const int parts = cycles ? 3 : 1;
    for (int part = 1; part <= parts; ++part) {
      const double back_m = cycles && part < parts ? random.uniform(0.002, 0.005) : 0.0;
      const double from_m = part == 1 ? 0.0 : above_m + depth_m * (part - 1) / parts - 0.0;
      const double reach_m = above_m + depth_m * part / parts - from_m;
      move(reach_m, speed_m_s);
      if (random.chance(0.5)) t_s += random.uniform(0.5, 2.5);
      if (back_m > 0.0) {
        move(-back_m, speed_m_s);
        move(back_m, speed_m_s);
      }
    }
    t_s += 0.5;
  }
  for (double at_s = 0.0; at_s < t_s; at_s += 0.02) press.times_s.push_back(at_s);
  return press;
}

void draw_presses(const CaseRequest& request, SandPlan& plan, RandomStream& random) {
  const bool alike = request.kind == "not_decidable";
  const int sizes = alike ? 2 : random.integer(3, 5);
  std::vector<double> widths;
  for (int i = 0; i < sizes; ++i) widths.push_back(0.04 + 0.02 * i + random.uniform(0.0, 0.01));
  // Rate and rest look like unloading where both are there; unloading needs to be seen.
  const bool cycles = !asks_for(request, "rate_dependence") && !alike &&
                      (asks_for(request, "unload_hysteresis") || random.chance(0.3));
  const int count = alike ? 5 : random.integer(6, 9);
  const double first_speed = random.uniform(0.002, 0.004), growth = random.uniform(0.001, 0.002);
  const int offset = random.integer(0, sizes - 1);
  for (int i = 0; i < count; ++i) {
    const double speed = alike ? first_speed + growth * i : random.log_uniform(0.0015, 0.012);
    const double width = widths[std::size_t((i * 2 + offset) % sizes)];
    plan.presses.push_back(draw_press(request, width, speed, cycles, random));
    plan.presses.back().index = i;
    plan.holdout.push_back(false);
  }
  plan.holdout[std::size_t(random.integer(1, count - 1))] = true;
  if (count > 6 && !plan.holdout[2]) plan.holdout[2] = true;
}

void draw_doubts(const CaseRequest& request, SandPlan& plan, RandomStream& random) {
  const auto doubt = [&](const char* key, double SandBed::*field, double truth, double spread) {
    const bool right = request.kind == "none";
    const double error = random.sign() * spread * random.uniform(0.5, 1.2);
    plan.doubts.push_back({key, field, right ? truth : truth + error, spread});
  };
  SandBed& bed = plan.bed;
  // Where k_c is not known a plate's size can mean anything.
  if (request.kind != "not_decidable") {
    doubt("k_c", &SandBed::k_c, bed.k_c, 0.03 * 0.05 * bed.k_phi + 0.2 * std::abs(bed.k_c));
  }
  doubt("k_phi", &SandBed::k_phi, bed.k_phi, 0.2 * bed.k_phi);
  doubt("n", &SandBed::n, bed.n, 0.1);
}

}  // namespace

SandPlan draw_sand_plan(const CaseRequest& request, RandomStream& random) {
  SandPlan plan;
  plan.bed.n = random.uniform(0.8, 1.3);
  // 20 kPa to 120 kPa at a depth of 20 mm.
  plan.bed.k_phi = random.log_uniform(2e4, 1.2e5) / std::pow(0.02, plan.bed.n);
  plan.bed.k_c = random.uniform(0.0, 0.15) * plan.bed.k_phi * 0.03;
  draw_presses(request, plan, random);
  draw_doubts(request, plan, random);
  plan.snr_db = random.uniform(15.0, 40.0);
  plan.position_sigma_m = random.log_uniform(2e-6, 2e-5);
  plan.millimetres = random.chance(0.3);
  plan.noise_given = random.chance(0.5);
  plan.rigid_beside =
      asks_for(request, "rig_compliance") ? random.chance(0.6) : random.chance(0.15);
  return plan;
}

double usual_depth_m(const SandPlan& plan) {
  std::vector<double> deepest;
  for (const SandPress& press : plan.presses) {
    const std::vector<double> depth = carriage_depth(press);
    deepest.push_back(*std::max_element(depth.begin(), depth.end()));
  }
  std::sort(deepest.begin(), deepest.end());
  return deepest[deepest.size() / 2];
}

double largest_force_N(const SandPlan& plan) {
  double most = 0.0;
  for (const SandPress& press : plan.presses) {
    const auto force = sand_force(plan.bed, {}, press, carriage_depth(press));
    most = std::max(most, *std::max_element(force.begin(), force.end()));
  }
  return most;
}

HiddenEffect draw_sand_effect(const std::string& name, double share, const SandPlan& plan,
                              RandomStream& random) {
  const double depth_m = usual_depth_m(plan);
  const double pressure_Pa = plan.bed.k_phi * std::pow(depth_m, plan.bed.n);
  const auto one = [&](const char* parameter, double value, const char* unit) {
    return std::vector<EffectParameter>{{parameter, value, unit}};
  };
  HiddenEffect effect{name, true, {}};
  auto& p = effect.parameters;
  if (name == "rig_compliance") {
    p = one("compliance", 1.2 * share * depth_m / largest_force_N(plan), "m/N");
  } else if (name == "plate_size_law") {
    p = one("exponent", random.sign() * 2.0 * share, "1");
  } else if (name == "rate_dependence") {
    p = one("coefficient", share / 0.006, "s/m");
  } else if (name == "cohesion") {
    p = one("strength", 0.5 * share * pressure_Pa, "Pa");
  } else if (name == "wall_confinement") {
    p = one("coefficient", 2.0 * share * std::pow(0.1 / depth_m, 2), "1");
  } else if (name == "hard_layer") {
    p = {{"depth", depth_m * random.uniform(0.4, 0.75), "m"}, {"ratio", 1.0 + 6.0 * share, "1"}};
  } else if (name == "packing_change") {
    p = one("drift", 0.4 * share, "1 per press");
  } else if (name == "unload_hysteresis") {
    p = one("ratio", 1.0 + 8.0 * share, "1");
  } else {
    effect.listed = false;
    if (name == "creep_at_rest") p = one("share", std::min(1.5 * share, 0.7), "1");
    if (name == "stick_slip_in_sand") {
      p = {{"share", std::min(share, 0.4), "1"},
           {"pitch", depth_m * random.uniform(0.06, 0.15), "m"}};
    }
    if (name == "unlevel_plate") p = one("depth", 1.5 * share * depth_m, "m");
    if (name == "side_friction") {
      p = one("coefficient", share * pressure_Pa * 0.015 / (depth_m * depth_m), "N/m3");
    }
    if (name == "bearing_limit") p = one("pressure", 0.5 * pressure_Pa / share, "Pa");
  }
  return effect;
}

}  // namespace hoof::tools::conceal
