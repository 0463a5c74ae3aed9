// Shares of the contract's section 5, and the streams of random numbers.

#include "tools/conceal/deck.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "tools/conceal/sand_bench.h"
#include "tools/conceal/servo_sizes.h"

using namespace hoof::tools::conceal;

TEST_CASE("shares come out to the nearest whole case and add up") {
  CHECK(apportion(400, {0.15, 0.15, 0.35, 0.15, 0.15, 0.05}) ==
        std::vector<int>{60, 60, 140, 60, 60, 20});
  CHECK(apportion(20, {0.15, 0.15, 0.35, 0.15, 0.15, 0.05}) == std::vector<int>{3, 3, 7, 3, 3, 1});
  for (int count = 1; count < 60; ++count) {
    const auto counts = apportion(count, {0.15, 0.15, 0.35, 0.15, 0.15, 0.05});
    CHECK(std::accumulate(counts.begin(), counts.end(), 0) == count);
  }
}

TEST_CASE("a batch of 400 has the contract's shares, four fifths servos, and every effect") {
  const auto cases = deal(400, "all", RandomStream(3));
  std::map<std::string, int> kinds, rigs;
  std::set<std::string> single, paired, unlisted;
  for (const DealtCase& c : cases) {
    ++kinds[c.request.kind];
    ++rigs[c.rig];
    if (c.request.kind == "one") single.insert(c.request.effects[0]);
    if (c.request.kind == "unknown") unlisted.insert(c.request.effects[0]);
    if (c.request.kind == "not_decidable") {
      CHECK(c.request.alike.size() == 2);
    }
    if (c.request.kind != "pair") continue;
    REQUIRE(c.request.effects.size() == 2);
    CHECK(c.request.effects[0] != c.request.effects[1]);
    paired.insert(c.request.effects.begin(), c.request.effects.end());
  }
  CHECK(rigs == std::map<std::string, int>{{"plate_sand", 80}, {"servo_pendulum", 320}});
  CHECK(kinds == std::map<std::string, int>{{"none", 60},
                                            {"none_wrong_parameters", 60},
                                            {"not_decidable", 20},
                                            {"one", 140},
                                            {"pair", 60},
                                            {"unknown", 60}});
  const std::size_t listed = listed_servo_effects().size() + listed_sand_effects().size();
  CHECK(listed == 22);
  CHECK(single.size() == listed);
  CHECK(paired.size() == listed);
  CHECK(unlisted_servo_effects().size() >= 10);
  CHECK(unlisted_sand_effects().size() >= 4);
  CHECK(unlisted.size() == unlisted_servo_effects().size() + unlisted_sand_effects().size());
}

TEST_CASE("random numbers: uniform, normal, and branches that are streams of their own") {
  RandomStream random(11);
  double mean = 0, square = 0, normal = 0, normal2 = 0, low = 1, high = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform(), g = random.normal();
    mean += u / kCount, square += u * u / kCount, normal += g / kCount, normal2 += g * g / kCount;
    low = std::min(low, u), high = std::max(high, u);
  }
  // Five deviations of each mean.
  CHECK(mean == Approx(0.5).margin(0.005));
  CHECK(square == Approx(1.0 / 3.0).margin(0.005));
  CHECK(normal == Approx(0.0).margin(0.016));
  CHECK(normal2 == Approx(1.0).margin(0.023));
  CHECK(low >= 0.0);
  CHECK(high < 1.0);
  const auto first = [](RandomStream stream) { return stream.uniform(); };
  const RandomStream parent(11);
  CHECK(first(parent.branch(0).branch(1)) != first(parent.branch(1).branch(0)));
  CHECK(first(parent.branch(4)) == first(RandomStream(11).branch(4)));
}
