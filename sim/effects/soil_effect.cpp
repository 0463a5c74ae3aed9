#include "sim/effects/soil_effect.h"

#include <algorithm>
#include <cmath>

namespace hoof::sim {
namespace {

double resistance_N(const SoilContact& contact, SoilEffects effects) {
  double force_N = contact.stiffness_N_m * std::pow(contact.depth_m, contact.exponent);
  for (const auto& effect : effects) force_N = effect->strength_N(force_N, contact);
  for (const auto& effect : effects) force_N = effect->force_N(force_N, contact);
  return force_N;
}

}  // namespace

double soil_force_N(const SoilContact& contact, SoilEffects effects) {
  if (!(contact.depth_m > 0)) return 0;
  double force_N = resistance_N(contact, effects);
  if (contact.depth_m < contact.deepest_m && !effects.empty()) {
    SoilContact deepest = contact;
    deepest.depth_m = contact.deepest_m;
    const double deepest_N = resistance_N(deepest, effects);
    for (const auto& effect : effects) {
      force_N = effect->unloading_N(force_N, deepest_N, contact);
    }
  }
  return std::max(force_N, 0.0);
}

double rig_travel_m(double force_N, SoilEffects effects) {
  double sum_m = 0;
  for (const auto& effect : effects) sum_m += effect->rig_travel_m(force_N);
  return sum_m;
}

double extra_depth_m(const SoilContact& contact, SoilEffects effects) {
  double sum_m = 0;
  for (const auto& effect : effects) sum_m += effect->extra_depth_m(contact);
  return sum_m;
}

double spine_loss_m(SoilEffects effects) {
  double sum_m = 0;
  for (const auto& effect : effects) sum_m += effect->spine_loss_m();
  return sum_m;
}

}  // namespace hoof::sim
