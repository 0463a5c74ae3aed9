// What a closed system keeps: momentum, angular momentum (without own-spin rolling friction),
// energy (elastic and without friction).
#include <catch2/catch.hpp>
#include <random>

#include "tests/sim/dem/paper_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

/// A cloud of grains without overlaps, all flying about, in a box of `cells`^3 lattice places.
BedState gas(int cells, double speed_m_s, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  BedState state;
  const double pitch_m = 6.6e-3;
  std::uint32_t id = 0;
  for (int x = 0; x < cells; ++x) {
    for (int y = 0; y < cells; ++y) {
      for (int z = 0; z < cells; ++z) {
        const double d = 4.2e-3 + 2.2e-3 * unit(random);
        const Eigen::Vector3d centre =
            pitch_m * (Eigen::Vector3d(x, y, z) - Eigen::Vector3d::Constant((cells - 1) / 2.0));
        const auto any = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
        state.grains.push_back(grain_at(id++, d, centre, speed_m_s * any(), 100 * any()));
      }
    }
  }
  return state;
}

Eigen::Vector3d angular_momentum(const BedState& s) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Grain& g : s.grains) {
    const double m = grain_mass_kg(2 * g.radius_m);
    sum += m * g.p_m.cross(g.v_m_s) + 0.4 * m * g.radius_m * g.radius_m * g.w_rad_s;
  }
  return sum;
}

}  // namespace

TEST_CASE("collisions keep linear momentum, rolling friction on") {
  const unsigned seed = 20261122;
  INFO("seed " << seed);
  DemSettings s = paper_settings(6.6e-3 * 5);
  s.periodic = {true, true, true};
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    s.precision = precision;
    SandBed bed(s, gas(10, 1.0, seed));
    const Eigen::Vector3d before = bed.momentum_kg_m_s();
    double scale = 0;
    for (const Grain& g : bed.state().grains) {
      scale += grain_mass_kg(2 * g.radius_m) * g.v_m_s.norm();
    }
    bed.advance(4000);
    CHECK(bed.health().renewed > 10000);
    CHECK(bed.kinetic_energy_J() < 0.9 * 0.5 * scale);  // they did collide
    // Both sides of a contact are computed with the same operations, so only the sums round:
    // sqrt(4000 steps x 4 contacts) times 6e-8, or 1e-16, of a typical grain's share.
    const double tolerance = precision == Precision::kDouble ? 1e-14 : 1e-6;
    CHECK((bed.momentum_kg_m_s() - before).norm() < tolerance * scale);
  }
}

TEST_CASE("collisions keep angular momentum when there is no rolling friction") {
  DemSettings s = paper_settings(0.1);
  BedState start = gas(4, 1.0, 7);
  for (Grain& g : start.grains) g.v_m_s -= 0.5 * g.p_m / 6.6e-3;  // flying together
  const Eigen::Vector3d before = angular_momentum(start);
  double scale = 0;
  for (const Grain& g : start.grains) {
    scale += grain_mass_kg(2 * g.radius_m) * g.p_m.norm() * g.v_m_s.norm();
  }
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    s.precision = precision;
    s.grain_grain.rolling_friction = 0;
    SandBed bed(s, start);
    const double energy = bed.kinetic_energy_J();
    bed.advance(4000);
    CHECK(bed.kinetic_energy_J() < 0.8 * energy);
    // Exact but for the leapfrog's half step between p and v (a collision lasts 60 steps) and the
    // arms r - delta/2 of unequal grains, which meet a third of an overlap apart: delta/r is 1e-2
    // here.
    CHECK((angular_momentum(bed.state()) - before).norm() < 2e-4 * scale);

    s.grain_grain.rolling_friction = 0.34;
    SandBed rolling(s, start);
    rolling.advance(4000);
    CHECK((angular_momentum(rolling.state()) - before).norm() > 1e-3 * scale);
  }
}

TEST_CASE("elastic grains without friction keep their energy") {
  DemSettings s = paper_settings(6.6e-3 * 3);
  s.periodic = {true, true, true};
  s.grain_grain = {1, 0, 0};
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    s.precision = precision;
    SandBed bed(s, gas(6, 0.5, 11));
    const double before = bed.kinetic_energy_J();
    double lowest = before, highest = 0;
    for (int i = 0; i < 40; ++i) {
      bed.advance(250);
      lowest = std::min(lowest, bed.kinetic_energy_J());
      highest = std::max(highest, bed.kinetic_energy_J());
    }
    // Some energy sits in the overlaps at any moment, so the kinetic energy dips; it must come
    // back. Leapfrog errors of single collisions are under 0.5 % and average out.
    CHECK(lowest > 0.8 * before);
    CHECK(highest < 1.01 * before);
    CHECK(highest > 0.95 * before);
  }
}
