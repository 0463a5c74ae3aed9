// Pairs, walls, meshes and edges against LIGGGHTS's records (tests/data/dem/liggghts).
#include <catch2/catch.hpp>

#include "tests/sim/dem/liggghts/reference.h"

using namespace hoof::sim;
using namespace hoof::sim::test;

namespace {

void check_against_record(const FreeCase& c) {
  const Dump theirs = read_record(record_file(c.name));
  REQUIRE(theirs.at(c.steps).size() == c.grains.size());
  if (c.traced > 0) REQUIRE(theirs.size() == std::size_t(c.steps / kTraceSteps));
  for (const Precision precision : {Precision::kMixed, Precision::kDouble}) {
    check_agreement(c, precision, our_engine(c, precision, theirs), theirs);
  }
}

}  // namespace

TEST_CASE("the comparison sees a wrong rolling law, cap, material and radius") {
  FreeCase c = oblique_pairs();
  const Dump theirs = read_record(record_file(c.name));
  const auto worst = [&](const DemSettings& s) {
    return compare(c, our_engine(c, s, theirs), theirs).speed;
  };
  const DemSettings right = settings_of(c, Precision::kDouble);
  DemSettings rolling = right, cap = right, stiffness = right, step = right;
  rolling.rolling_law = RollingLaw::kOwnSpin;
  cap.coulomb_cap = CoulombCap::kElasticNormal;
  stiffness.grain_material.young_modulus_Pa *= 1.001;
  step.dt_s *= 1.001;
  CHECK(worst(right) < 1e-7);
  CHECK(worst(rolling) > 1e-2);
  CHECK(worst(cap) > 1e-3);
  CHECK(worst(stiffness) > 1e-5);
  CHECK(worst(step) > 1e-5);
}

TEST_CASE("oblique pairs move and part as in LIGGGHTS") {
  check_against_record(oblique_pairs());
}

TEST_CASE("oblique impacts on a plane go as in LIGGGHTS") {
  check_against_record(oblique_impacts_on_plane());
}

TEST_CASE("oblique impacts on a mesh go as in LIGGGHTS") {
  check_against_record(oblique_impacts_on_mesh());
}

TEST_CASE("impacts on edges and corners of a mesh go as in LIGGGHTS") {
  check_against_record(impacts_on_edges());
}
