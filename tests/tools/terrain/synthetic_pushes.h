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
    std::size_t next = 0;
    for (const tools::PushLeg& leg : tools::legs_of(plate)) {
      if (leg.phase == tools::PushPhase::kInsert) continue;
      for (int i = 0; i < leg.intervals; ++i) {
        const Eigen::Vector3d off(gauss(random), gauss(random), gauss(random));
        push.samples.push_back({leg.phase, (i + 0.5) * leg.way_m.norm() / leg.intervals,
                                forces[next++] + noise * std::sqrt(square) * off});
      }
    }
    pushes.push_back(push);
  }
  return pushes;
}

}  // namespace hoof::tests
