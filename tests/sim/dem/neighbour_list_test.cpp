// The list that is kept good piece by piece, against looking at all pairs.
#include "sim/dem/neighbour_list.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/sim/dem/falling_heap.h"

using namespace hoof::sim;

namespace {

template <typename Real>
struct Swarm {
  using List = NeighbourList<Real>;
  using Record = GrainRecord<Real>;

  Swarm(unsigned seed, bool periodic, int threads)
      : domain(Domain::spanning({0, 0, 0}, {0.06, 0.05, 0.08}, {periodic, periodic, false})),
        team(threads),
        random(seed) {
    for (std::uint32_t i = 0; i < 500; ++i) {
      Record r{};
      double rest;
      r.x = domain.to_steps<Real>(0, 0.01 + 0.04 * unit(), rest);
      r.y = domain.to_steps<Real>(1, 0.01 + 0.03 * unit(), rest);
      r.z = domain.to_steps<Real>(2, 0.02 + 0.04 * unit(), rest);
      r.radius_m = Real(1e-3 + 2.2e-3 * unit() * unit());
      r.id = 7 * i;  // names are not places
      records.push_back(r);
    }
    records.resize(512);
    scratch = records;
    list.sort(records, scratch, 500, domain, {3.2e-3, skin_m, 5e-3}, team);
  }

  double unit() { return std::uniform_real_distribution<double>(0, 1)(random); }

  /// Moves every grain, a few of them far.
  void move() {
    double furthest[2] = {0, 0};
    for (std::uint32_t row = 0; row < 500; ++row) {
      const double far_m = unit() < 0.02 ? 60e-6 : 2e-6;
      const Eigen::Vector3d d_m =
          far_m / std::sqrt(3.0) * Eigen::Vector3d(unit() * 2 - 1, unit() * 2 - 1, unit() * 2 - 1);
      Record& r = records[row];
      const auto shift = [&](auto& x, int axis) {
        using Steps = std::remove_reference_t<decltype(x)>;
        using Unsigned = std::make_unsigned_t<Steps>;
        x = Steps(Unsigned(x) + Unsigned(Steps(d_m[axis] / domain.lsb_m<Real>(axis))));
      };
      shift(r.x, 0), shift(r.y, 1), shift(r.z, 2);
      furthest[row / 256] = std::max(furthest[row / 256], d_m.norm());
    }
    list.travelled([&](std::size_t w) { return furthest[w]; });
    renewed += list.update(records, team);
  }

  double gap_m(std::uint32_t i, std::uint32_t j) const {
    Eigen::Vector3d d = domain.position_m(records[i]) - domain.position_m(records[j]);
    for (int axis = 0; axis < 3; ++axis) {
      if (domain.periodic[std::size_t(axis)]) {
        d[axis] -= domain.length_m(axis) * std::round(d[axis] / domain.length_m(axis));
      }
    }
    return d.norm() - double(records[i].radius_m) - double(records[j].radius_m);
  }

  /// Every pair that touches must be listed, from both sides, at its row's place.
  int missing() const {
    int n = 0;
    for (std::uint32_t i = 0; i < 500; ++i) {
      for (std::uint32_t j = 0; j < 500; ++j) {
        if (i != j && gap_m(i, j) < 0) n += list.find(i, j) < 0;
      }
    }
    return n;
  }

  std::vector<std::int32_t> row(const List& l, std::uint32_t i) const {
    std::vector<std::int32_t> r;
    const std::uint32_t begin = l.slot_begin()[i / kLanes];
    for (std::uint32_t s = begin; s < begin + l.slot_count()[i / kLanes]; ++s) {
      const std::int32_t j = l.slots()[s].neighbour[i % kLanes];
      if (j != std::int32_t(i)) r.push_back(j);
    }
    return r;
  }

  static constexpr double skin_m = 1e-4;
  Domain domain;
  ThreadTeam team;
  std::mt19937 random;
  typename List::Records records, scratch;
  List list;
  std::size_t renewed = 0;
};

}  // namespace

TEMPLATE_TEST_CASE("no touching pair is ever missing from the list", "", float, double) {
  const bool periodic = GENERATE(false, true);
  const unsigned seed = GENERATE(1u, 2u, 3u);
  INFO("seed " << seed << (periodic ? ", periodic" : ""));
  Swarm<TestType> swarm(seed, periodic, 2);
  REQUIRE(swarm.missing() == 0);
  for (int i = 0; i < 60; ++i) {
    swarm.move();
    INFO("move " << i);
    REQUIRE(swarm.missing() == 0);
  }
  CHECK(swarm.renewed > 300);   // the test has seen updates,
  CHECK(swarm.renewed < 6000);  // and they were few: 30,000 moves were made
}

TEST_CASE("what is listed, and in which order, follows from the references alone") {
  // So a list made from saved references is the very list that was saved, on any number of threads.
  Swarm<float> swarm(5, true, 1), threaded(5, true, 3);
  for (int i = 0; i < 40; ++i) swarm.move(), threaded.move();
  ByteWriter saved;
  swarm.list.save(saved);
  const std::string bytes = saved.take();
  ByteReader in(bytes);
  NeighbourList<float> loaded;
  loaded.load(in, swarm.records, 500, swarm.domain, swarm.team);
  CHECK(in.at_end());
  int listed = 0;
  for (std::uint32_t i = 0; i < 500; ++i) {
    INFO("row " << i);
    REQUIRE(swarm.row(loaded, i) == swarm.row(swarm.list, i));
    REQUIRE(swarm.row(threaded.list, i) == swarm.row(swarm.list, i));
    listed += int(swarm.row(loaded, i).size());
  }
  CHECK(listed > 500);
}

TEST_CASE("a periodic bed narrower than three reaches is refused") {
  hoof::sim::DemSettings s = test::falling(Precision::kMixed);
  s.high_m.x() = s.low_m.x() + 0.015;
  BedState state;
  state.grains = {test::grain_at(0, 6.4e-3, {-0.02, 0, 0.01})};
  CHECK_THROWS_WITH(SandBed(s, state), Catch::Contains("three reaches wide: 0.015"));
}
