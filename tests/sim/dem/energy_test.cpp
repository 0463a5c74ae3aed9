// What goes in, less what is lost, is what is there.
#include <catch2/catch.hpp>

#include "tests/sim/dem/falling_heap.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

TEST_CASE("a heap that falls, comes to rest and is stirred keeps its books") {
  const Precision precision = GENERATE(Precision::kMixed, Precision::kDouble);
  const RollingLaw rolling = GENERATE(RollingLaw::kOwnSpin, RollingLaw::kRelativeSpin);
  DemSettings s = falling(precision);
  s.rolling_law = rolling;
  s.account_energy = true;
  SandBed bed(s, heap(4));
  const int box =
      bed.add_mesh(box_mesh({8e-3, 6e-3, 5e-3}), {0, 0, 0.09}, Eigen::Quaterniond::Identity());
  bed.advance(1);
  const double start_J = bed.energy().total_J();
  const double fallen_from_J = bed.energy().potential_J;
  bed.advance(20000);  // 56 ms: most of the fall and of the rest
  const EnergyBalance rest = bed.energy();
  const double lost_J = rest.lost_J();
  CHECK(lost_J > 0.3 * (fallen_from_J - rest.potential_J));
  // Of second order in the step; 0.2 to 0.5 % of the losses were measured here.
  CHECK(std::abs(rest.total_J() - start_J) < 0.01 * lost_J);
  for (const double part_J :
       {rest.grain_grain.lost_normal_dashpot_J, rest.grain_grain.lost_tangential_J,
        rest.grain_grain.lost_rolling_J, rest.grain_grain.stored_normal_J,
        rest.boundary.lost_normal_dashpot_J, rest.boundary.stored_normal_J}) {
    CHECK(part_J > 0);
  }
  // A box that crushes grains against the floor at 2.2 m/s: overlaps of a tenth of a radius, which
  // 12 steps make. 5 % were measured.
  bed.set_motion(box, {{0, 0, 0.09}, Eigen::Quaterniond::Identity(), {0, 0, -2.2}, {0, 0, 5}});
  bed.advance(10000);
  const EnergyBalance stirred = bed.energy();
  CHECK(stirred.work_by_meshes_J > 0.01 * lost_J);
  CHECK(std::abs(stirred.total_J() - start_J) < 0.08 * stirred.lost_J());
}

TEST_CASE("a viscous medium takes what it takes") {
  DemSettings s = paper_settings();
  s.viscous_rate_1_s = 100;
  s.account_energy = true;
  BedState one;
  one.grains = {grain_at(0, 4e-3, {0, 0, 0}, {1, 0, 0}, {0, 50, 0})};
  SandBed bed(s, one);
  bed.advance(1);
  const double start_J = bed.energy().total_J();
  bed.advance(2000);
  const EnergyBalance e = bed.energy();
  CHECK(e.viscous_loss_J > 0.5 * start_J);
  CHECK(e.total_J() == Approx(start_J).epsilon(1e-3));
}

TEST_CASE("an audit finds the deepest overlap and how stiff the stiffest grain is held") {
  // Two grains squeezed by hand: overlap 2 % of the smaller radius.
  DemSettings s = paper_settings();
  s.precision = Precision::kDouble;
  s.audit_steps = 1;
  BedState pair;
  const double overlap_m = 2e-5;
  pair.grains = {grain_at(0, 2e-3, {0, 0, 0}), grain_at(1, 4e-3, {3e-3 - overlap_m, 0, 0})};
  SandBed bed(s, pair);
  bed.advance(1);
  CHECK(bed.health().deepest_ratio == Approx(0.02).epsilon(1e-9));
  const PairLaw<double> law = make_pair_law(s.grain_material, s.grain_material, s.grain_grain);
  const double a_m = std::sqrt(1e-3 * 2e-3 / 3e-3 * overlap_m);
  const double stiffness_N_m = (2 * law.E_eff_Pa + 8 * law.G_eff_Pa) * a_m;
  CHECK(bed.health().step_ratio ==
        Approx(s.dt_s / 2 * std::sqrt(stiffness_N_m / grain_mass_kg(2e-3))).epsilon(1e-9));
}

TEST_CASE("an unstable step is found before anything flies") {
  DemSettings s = paper_settings();
  s.precision = Precision::kDouble;
  s.audit_steps = 1;
  s.dt_s = 6e-5;
  BedState pair;
  pair.grains = {grain_at(0, 2e-3, {0, 0, 0}), grain_at(1, 2e-3, {2e-3 - 1e-4, 0, 0})};
  SandBed bed(s, pair);
  CHECK_THROWS_WITH(bed.advance(1), Catch::Contains("step 1") && Catch::Contains("60.0") &&
                                        Catch::Contains("bed.steps_per_ms"));
}

TEST_CASE("a grain behind a wall or at the domain's edge is found and named") {
  DemSettings s = paper_settings();
  s.walls = {{Eigen::Vector3d::UnitZ(), -0.02}};
  s.wall_material.young_modulus_Pa = 1;  // or it would throw the grain out at once
  s.audit_steps = 100;
  BedState state;
  state.grains = {grain_at(0, 4e-3, {0, 0, 0}), grain_at(7, 4e-3, {0.01, 0, -0.0221})};
  SandBed through(s, state);  // its centre is further behind the wall than its radius
  CHECK_THROWS_WITH(through.advance(1), Catch::Contains("lost at step 1: grain 7 of 4.0") &&
                                            Catch::Contains("bed.steps_per_ms"));
  state.grains = {grain_at(0, 4e-3, {0, 0, 0}), grain_at(7, 4e-3, {0.0495, 0, 0}, {1, 0, 0})};
  SandBed leaving(s, state);
  CHECK_THROWS_WITH(leaving.advance(200),
                    Catch::Contains("lost at step") && Catch::Contains("edge of the domain"));
}
