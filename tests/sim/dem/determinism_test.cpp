// The same bytes from any number of threads, on any instruction set, and across rebuilds.
#include <catch2/catch.hpp>

#include "tests/sim/dem/falling_heap.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

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
  CHECK(bed.health().rebuilds > 5);     // sorts, with a change of skin
  CHECK(bed.health().renewed > 50000);  // every grain some sixty times
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
  // Two grains pressed and sheared; a third flies past the first, nearer than the skin, so that its
  // list is written again and again. The pair must not care.
  DemSettings s = paper_settings();
  s.precision = Precision::kDouble;
  BedState pair;
  pair.grains = {grain_at(0, 4e-3, {0, 0, 0}, {0.1, 0.01, 0}),
                 grain_at(1, 4e-3, {4e-3, 0, 0}, {-0.1, -0.01, 0})};
  BedState three = pair;
  three.grains.push_back(grain_at(2, 4e-3, {-0.0001, 4.1e-3, 0}, {3, 0, 0}));
  s.skin_m = 2e-4;
  SandBed alone(s, pair), watched(s, three);
  alone.advance(40);  // inside the contact
  watched.advance(40);
  const BedState a = alone.state(), w = watched.state();
  REQUIRE(a.contacts.size() == 1);
  REQUIRE(w.contacts.size() == 1);
  CHECK(alone.health().renewed == 0);
  CHECK(watched.health().renewed >= 3);
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
  CHECK_THROWS_WITH(bed.advance(1000), Catch::Contains("blow-up at step") &&
                                           Catch::Contains("grain 1 of 4") &&
                                           Catch::Contains("bed.steps_per_ms"));
}
