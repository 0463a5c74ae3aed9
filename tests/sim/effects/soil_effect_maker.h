// Effects by name, and a contact to try them on.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/effects/effect.h"

namespace hoof::tests {

using SoilEffectList = std::vector<std::unique_ptr<sim::SoilEffect>>;

inline std::unique_ptr<sim::SoilEffect> make_soil_effect(const std::string& name,
                                                         const std::vector<double>& values) {
  const sim::EffectInfo* info = sim::find_effect(name);
  if (info == nullptr || !info->make_soil) throw std::invalid_argument(name);
  if (values.size() != info->parameters.size()) throw std::invalid_argument(name + ": values");
  return info->make_soil(values);
}

inline SoilEffectList one(const std::string& name, const std::vector<double>& values) {
  SoilEffectList list;
  list.push_back(make_soil_effect(name, values));
  return list;
}

/// A disc of 80 mm, 10 mm deep in sand of k_phi = 3e6 N/m^3.2, going down at 2 mm/s.
inline sim::SoilContact contact_at(double depth_m) {
  return {.depth_m = depth_m,
          .deepest_m = 0,
          .speed_m_s = 0.002,
          .area_m2 = 5.0265e-3,
          .width_m = 0.04,
          .wall_distance_m = 0,
          .press = 0,
          .shear_m = 0,
          .time_s = 0,
          .stiffness_N_m = 5.0265e-3 * 3e6,
          .exponent = 1.2};
}

}  // namespace hoof::tests
