// The same bytes from any number of threads, on any instruction set, and across rebuilds.
#include <catch2/catch.hpp>
#include <random>

#include "tests/sim/dem/paper_bed.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

BedState heap(unsigned seed) {
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

DemSettings falling(Precision precision) {
  DemSettings s = paper_settings(0.1);
  s.low_m = {-0.0264, -0.0264, -0.02};
  s.high_m = {0.0264, 0.0264, 0.1};
  s.periodic = {true, true, false};
  s.walls = {{Eigen::Vector3d::UnitZ(), 0}};
  s.gravity_m_s2 = {0, 0, -9.81};
  s.precision = precision;
  return s;
}

struct Outcome {
  std::uint64_t hash;
  Eigen::Vector3d impulse;
};

/// Grains rain on a floor while a turning box is driven into them.
Outcome run(const DemSettings& s) {
  SandBed bed(s, heap(3));
  const int box =
      bed.add_mesh(box_mesh({8e-3, 6e-3, 5e-3}), {0, 0, 0.06}, Eigen::Quaterniond::Identity());
  bed.set_motion(box, {{0, 0, 0.06}, Eigen::Quaterniond::Identity(), {0.3, 0, -2}, {0, 1, 3}});
  bed.advance(6000);
  CHECK(bed.health().rebuilds > 20);
  return {bed.state_hash(), bed.take_load(box).impulse_W_Ns};
}

}  // namespace

TEST_CASE("threads and instruction sets change no bit") {
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    DemSettings s = falling(precision);
    const Outcome one = run(s);
    CHECK(one.impulse.norm() > 0);
    for (const int threads : {2, 3, 4}) {
      s.threads = threads;
      const Outcome many = run(s);
      INFO(threads << " threads");
      CHECK(many.hash == one.hash);
      CHECK(many.impulse == one.impulse);
    }
    s.threads = 1;
    for (const InstructionSet set :
         {InstructionSet::kPortable, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      if (!is_supported(set)) {
        WARN("this machine has no " << to_string(set) << ": not compared");
        continue;
      }
      s.instruction_set = set;
      const Outcome other = run(s);
      INFO(to_string(set));
      CHECK(other.hash == one.hash);
      CHECK(other.impulse == one.impulse);
    }
  }
}

TEST_CASE("a hash tells states apart") {
  DemSettings s = falling(Precision::kMixed);
  BedState a = heap(3), b = heap(3);
  b.grains[100].p_m.x() += 1e-9;
  CHECK(SandBed(s, a).state_hash() != SandBed(s, b).state_hash());
  CHECK(SandBed(s, a).state_hash() == SandBed(s, a).state_hash());
}

TEST_CASE("tangential history goes along when lists are made anew") {
  // Two grains pressed and sheared; a third flies about and forces rebuilds. The pair must not
  // care.
  DemSettings s = paper_settings();
  s.precision = Precision::kDouble;
  BedState pair;
  pair.grains = {grain_at(0, 4e-3, {0, 0, 0}, {0.1, 0.01, 0}),
                 grain_at(1, 4e-3, {4e-3, 0, 0}, {-0.1, -0.01, 0})};
  BedState three = pair;
  three.grains.push_back(grain_at(2, 4e-3, {-0.02, 0.02, 0}, {3, 0, 0}));
  s.skin_m = 2e-4;
  SandBed alone(s, pair), watched(s, three);
  alone.advance(40);  // inside the contact
  watched.advance(40);
  const BedState a = alone.state(), w = watched.state();
  REQUIRE(a.contacts.size() == 1);
  REQUIRE(w.contacts.size() == 1);
  CHECK(watched.health().rebuilds > alone.health().rebuilds);
  CHECK(a.contacts[0].xi_m.norm() > 1e-8);
  CHECK(w.contacts[0].xi_m == a.contacts[0].xi_m);
  CHECK(w.grains[0].w_rad_s == a.grains[0].w_rad_s);
}

TEST_CASE("a state put back goes on as it would have") {
  // Sums follow the order of the lists, and a new bed makes its lists anew: so compare physics, not
  // bytes. Without the contact history the shear springs would start from zero and the pair part
  // ways.
  DemSettings s = paper_settings();
  s.precision = Precision::kDouble;
  BedState pair;
  pair.grains = {grain_at(0, 4e-3, {0, 0, 0}, {0.1, 0.05, 0}),
                 grain_at(1, 4e-3, {4e-3, 0, 0}, {-0.1, -0.05, 0})};
  SandBed whole(s, pair);
  whole.advance(25);
  SandBed resumed(s, whole.state());
  BedState forgetful = whole.state();
  forgetful.contacts.clear();
  SandBed forgot(s, forgetful);
  whole.advance(100), resumed.advance(100), forgot.advance(100);
  const double wz = whole.state().grains[0].w_rad_s.z();
  CHECK(resumed.state().grains[0].w_rad_s.z() == Approx(wz).epsilon(1e-9));
  CHECK(forgot.state().grains[0].w_rad_s.z() != Approx(wz).epsilon(1e-2));
}

TEST_CASE("a bed that blows up says when, why and what to change") {
  DemSettings s = paper_settings();
  s.dt_s = 2e-4;
  BedState start;
  start.grains = {grain_at(0, 4e-3, {0, 0, 0}, {1, 0, 0}), grain_at(1, 4e-3, {3e-3, 0, 0})};
  SandBed bed(s, start);
  CHECK_THROWS_WITH(bed.advance(1000),
                    Catch::Contains("blow-up at step") && Catch::Contains("bed.dt_s"));
}
