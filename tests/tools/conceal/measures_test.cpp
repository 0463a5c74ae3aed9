// The measures on numbers that can be reckoned by hand.

#include "tools/conceal/measures.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::tools::conceal;

TEST_CASE("Clopper and Pearson: values of tables, nothing and all") {
  // 7 of 10: (0.348, 0.933), Clopper and Pearson's chart; 0 of n: 1 - 0.025^(1/n).
  CHECK(clopper_pearson(7, 10).low == Approx(0.3475).margin(1e-4));
  CHECK(clopper_pearson(7, 10).high == Approx(0.9333).margin(1e-4));
  CHECK(clopper_pearson(0, 20).low == 0.0);
  CHECK(clopper_pearson(0, 20).high == Approx(1.0 - std::pow(0.025, 0.05)));
  CHECK(clopper_pearson(20, 20).low == Approx(std::pow(0.025, 0.05)));
  CHECK(clopper_pearson(20, 20).high == 1.0);
}

TEST_CASE("the mean's interval is Student's") {
  const Bounds b = mean_bounds({1.0, 2.0, 3.0});
  // 2 +- 4.3027 / sqrt(3)
  CHECK(b.low == Approx(2.0 - 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
  CHECK(b.high == Approx(2.0 + 4.302653 / std::sqrt(3.0)).epsilon(1e-6));
}

TEST_CASE("overlap in time: parts, touching, other recordings, lists that overlap themselves") {
  CHECK(overlap({{"a", 0, 2}}, {{"a", 1, 3}}) == Approx(1.0 / 3.0));
  CHECK(overlap({{"a", 0, 2}}, {{"a", 0, 2}}) == Approx(1.0));
  CHECK(overlap({{"a", 0, 2}}, {{"b", 0, 2}}) == 0.0);
  CHECK(overlap({{"a", 0, 1}}, {{"a", 1, 2}}) == 0.0);
  CHECK(overlap({{"a", 0, 2}, {"a", 1, 3}}, {{"a", 0, 3}}) == Approx(1.0));
  CHECK(overlap({}, {{"a", 0, 1}}) == 0.0);
  CHECK(overlap({{"a", 0, 1}, {"b", 0, 3}}, {{"a", 0, 1}}) == Approx(0.25));
}

TEST_CASE("an interval holds the truth: ends, angles that go round, other readings") {
  const EffectParameter plain{"x", 2.0, "1"};
  CHECK(holds_truth(plain, {2.0, 1.5, 2.5}));
  CHECK(holds_truth(plain, {2.0, 2.0, 2.0}));
  CHECK_FALSE(holds_truth(plain, {2.2, 2.1, 2.5}));
  CHECK_FALSE(holds_truth(plain, {1.8, 1.5, 1.9}));
  const EffectParameter angle{"phase", 3.1, "rad", 6.283185307179586};
  CHECK(holds_truth(angle, {-3.18, -3.3, -3.1}));
  CHECK(holds_truth(angle, {9.38, 9.3, 9.5}));
  CHECK_FALSE(holds_truth(angle, {0.0, -0.2, 0.2}));
  EffectParameter read{"fraction", 0.2, "1"};
  read.other_readings = {0.3};
  CHECK(holds_truth(read, {0.3, 0.28, 0.32}));
  CHECK_FALSE(holds_truth(read, {0.25, 0.24, 0.26}));
}

TEST_CASE(
    "calibration: said 0.9 and right nine times in ten is none, always sure and half is 0.5") {
  std::vector<std::pair<double, bool>> said;
  for (int i = 0; i < 10; ++i) said.push_back({0.9, i > 0});
  CHECK(calibration_error(said) == Approx(0.0).margin(1e-12));
  said.clear();
  for (int i = 0; i < 10; ++i) said.push_back({1.0, i % 2 == 0});
  CHECK(calibration_error(said) == Approx(0.5));
  CHECK(calibration_error({{0.25, false}, {0.75, true}}) == Approx(0.25));
}

TEST_CASE("which picks are right") {
  TruthCase one, pair, unknown, none, alike;
  one.kind = "one", one.effects = {{"backlash", true, {}}};
  pair.kind = "pair", pair.effects = {{"backlash", true, {}}, {"actuator_lag", true, {}}};
  unknown.kind = "unknown", unknown.effects = {{"end_stop", false, {}}};
  none.kind = "none_wrong_parameters";
  alike.kind = "not_decidable", alike.effects = {{"supply_sag", true, {}}};
  alike.alike = {"supply_sag", "thermal_derating"};
  CHECK(right(one, pick_named("backlash")));
  CHECK_FALSE(right(one, pick_named("actuator_lag")));
  CHECK_FALSE(right(one, {"missing_physics", {"actuator_lag", "backlash"}, {}, 2}));
  CHECK(right(one, {"missing_physics", {"backlash", "actuator_lag"}, {}, 2}));
  CHECK_FALSE(right(one, {"not_separable", {"backlash"}, {}, 1}));
  CHECK(right(pair, pick_named("actuator_lag+backlash")));
  CHECK_FALSE(right(pair, pick_named("backlash")));
  CHECK(right(unknown, pick_named("unknown")));
  CHECK_FALSE(right(unknown, pick_named("none")));
  CHECK(right(none, pick_named("none")));
  CHECK_FALSE(right(none, pick_named("unknown")));
  CHECK(right(alike, {"not_separable", {}, {{"thermal_derating", "supply_sag", "x"}}, 0}));
  CHECK_FALSE(right(alike, {"not_separable", {}, {{"supply_sag", "x"}}, 0}));
  CHECK_FALSE(right(alike, pick_named("supply_sag")));
}

TEST_CASE("AIC and BIC pay for parameters as they should") {
  Answer answer;
  answer.hypotheses = {{"none", 5, -100.0, 1000}, {"backlash", 6, -97.0, 1000}};
  CHECK(pick_by_aic(answer) == std::vector<std::string>{"backlash"});  // 206 against 210
  CHECK(pick_by_bic(answer) == std::vector<std::string>{"none"});      // 6.9 a parameter
  CHECK(pick_by_aic({}).empty());
}
