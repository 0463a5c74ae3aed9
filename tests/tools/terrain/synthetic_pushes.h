// Pushes whose soil is known: predicted forces with noise.
#pragma once

#include <random>

#include "tools/terrain/fit_terrain.h"
#include "tools/terrain/soil_fit.h"

namespace hoof::tests {

inline sim::RftTerrainSettings planted(sim::PressureLaw law) {
  sim::RftTerrainSettings soil = tools::load_soil("demo");
  soil.pressure_law = law;
  soil.xi_n_N_m3.value = 7.5e5;
  soil.bekker_k_phi_Pa = 1.2e5;
  soil.bekker_k_c_N_m = 2.5e3;
  soil.bekker_exponent = 0.8;
  soil.yield_displacement_m.value = 0.6e-3;
  return soil;
}

/// @param noise of each component, over the rms force of the push
inline std::vector<tools::Push> synthetic_pushes(const sim::RftTerrainSettings& soil, double noise,
                                                 unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  std::vector<tools::Push> pushes;
  for (const tools::PushCase& plate : tools::standard_pushes(1)) {
    sim::RftTerrainSettings here = soil;
    here.bekker_width_m = plate.smaller_width_m();
    tools::Push push{plate, {}};
    const auto forces = tools::predict(plate, here);
    double square = 0;
    for (const auto& f : forces) square += f.squaredNorm() / double(forces.size());
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const Eigen::Vector3d off(gauss(random), gauss(random), gauss(random));
      push.samples.push_back({tools::PushPhase::kPush, (double(i) + 0.5) * 0.5e-3,
                              forces[i] + noise * std::sqrt(square) * off});
    }
    if (plate.back_m > 0) {
      const Eigen::Vector3d load = push.samples.back().force_N;
      for (int i = 0; i < 20; ++i) {
        const double way_m = (i + 0.5) * 0.05e-3;
        const double share = std::max(0.0, 1 - way_m / soil.yield_displacement_m.value);
        push.samples.push_back({tools::PushPhase::kBack, way_m, share * load});
      }
    }
    pushes.push_back(push);
  }
  return pushes;
}

}  // namespace hoof::tests
