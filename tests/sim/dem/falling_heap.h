// A few hundred grains that rain on a floor: much contact, much coming and going.
#pragma once

#include <random>

#include "tests/sim/dem/paper_bed.h"

namespace hoof::sim::test {

inline BedState heap(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  BedState state;
  std::uint32_t id = 0;
  for (int z = 0; z < 12; ++z) {
    for (int x = 0; x < 8; ++x) {
      for (int y = 0; y < 8; ++y) {
        const double d = 2e-3 + 4.4e-3 * unit(random);
        state.grains.push_back(grain_at(
            id++, d,
            Eigen::Vector3d(-0.0231 + 6.6e-3 * x, -0.0231 + 6.6e-3 * y, 3.3e-3 + 6.6e-3 * z),
            {0.2 * unit(random), 0.2 * unit(random), -0.5}));
      }
    }
  }
  return state;
}

inline DemSettings falling(Precision precision) {
  DemSettings s = paper_settings(0.1);
  s.low_m = {-0.0264, -0.0264, -0.02};
  s.high_m = {0.0264, 0.0264, 0.1};
  s.periodic = {true, true, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  s.gravity_m_s2 = {0, 0, -9.81};
  s.precision = precision;
  return s;
}

}  // namespace hoof::sim::test
