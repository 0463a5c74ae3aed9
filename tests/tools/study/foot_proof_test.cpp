// The foot's proof as a user starts it, of one effect; and what its numbers mean.
#include "tools/study/foot_proof.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "sim/effects/effect.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;
namespace fs = std::filesystem;

TEST_CASE("what is left is a mean over the channels that the nominal model misses") {
  const Errors noise = {{"a_rmse", 1}, {"b_rmse", 1}, {"c_rmse", 1}};
  const Errors before = {{"a_rmse", 10}, {"b_rmse", 100}, {"c_rmse", 1.5}};
  const Errors after = {{"a_rmse", 5}, {"b_rmse", 10}, {"c_rmse", 1.5}};
  CHECK(mean_share(before, after, noise) == Approx(0.3));  // c is within its noise
  CHECK(mean_share(before, before, noise) == Approx(1));
  CHECK(std::isnan(mean_share({{"c_rmse", 1.5}}, after, noise)));
}

TEST_CASE("an answer is right where it names just what was concealed, at its joint") {
  FootProof proof;
  proof.asked = {"toe", "backlash", "toe", {{"gap", 0.01}}, "sinkage", {}, false, ""};
  proof.verdict.verdict = "missing_physics";
  proof.verdict.named = {"backlash"};
  proof.verdict.effects = {{"backlash", 0.9, {}, "toe"}};
  CHECK(proof.right());
  proof.verdict.effects[0].joint = "hip";
  CHECK_FALSE(proof.right());
  proof.verdict.effects[0].joint = "toe";
  proof.verdict.named = {"backlash", "transport_delay"};
  CHECK_FALSE(proof.right());
  proof.verdict.named = {"backlash"};
  proof.verdict.verdict = "not_separable";
  CHECK_FALSE(proof.right());
  proof.asked.effect = "";
  CHECK_FALSE(proof.right());
  proof.verdict.verdict = "none";
  CHECK(proof.right());
}

TEST_CASE("cases name effects of the catalogue with all their parameters, and some are quick") {
  std::set<std::string> names, effects;
  int quick = 0;
  for (const FootProofCase& c : foot_proof_cases()) {
    INFO(c.name);
    CHECK(names.insert(c.name).second);
    quick += c.quick && !c.effect.empty() ? 1 : 0;
    if (c.effect.empty()) {
      CHECK(c.toml().empty());
      continue;
    }
    effects.insert(c.effect);
    const hoof::sim::EffectInfo* info = hoof::sim::find_effect(c.effect);
    REQUIRE(info != nullptr);
    REQUIRE(info->parameters.size() == c.values.size());
    for (std::size_t i = 0; i < c.values.size(); ++i) {
      CHECK(info->parameters[i].name == c.values[i].first);
    }
  }
  CHECK(quick == 2);
  CHECK(effects == std::set<std::string>{"backlash", "cohesion", "hard_layer",
                                         "load_dependent_friction", "spine_wear",
                                         "wall_confinement"});
}

TEST_CASE("play of the toes is concealed, found, and a second run with it is the session") {
  const ScratchFolder scratch;
  FootProofOptions options;
  options.out = scratch.path() / "proof";
  options.only = {"toe-play"};
  options.quiet = true;
  std::ostringstream text;
  std::streambuf* const console = std::cout.rdbuf(text.rdbuf());
  try {
    run_foot_proof_study(options);
  } catch (...) {
    std::cout.rdbuf(console);
    throw;
  }
  std::cout.rdbuf(console);
  INFO(text.str());
  CHECK(text.str().find("| backlash (toe)") != std::string::npos);
  const auto json = nlohmann::json::parse(read_file(options.out / "proof.json"));
  const auto& proof = json["cases"][0];
  CHECK(proof["named"] == nlohmann::json({"backlash"}));
  CHECK(proof["right"] == true);
  CHECK(proof["probability"].get<double>() > 0.8);
  CHECK(proof["values"]["gap"]["found"].get<double>() == Approx(0.012).epsilon(0.02));
  CHECK(proof["left_ratio"]["with_effect"].get<double>() < 0.1);
  CHECK(proof["left_ratio"]["with_best_rival"].get<double>() >
        4 * proof["left_ratio"]["with_effect"].get<double>());
  CHECK(proof["left_ratio"]["taken_away"].get<double>() > 0.9);
  CHECK(proof["left_ratio"]["second_run"].get<double>() < 0.1);
  // The folder that was diagnosed tells nothing.
  CHECK(read_file(options.out / "toe-play" / "session" / "settings.toml").find("backlash") ==
        std::string::npos);
  CHECK_THROWS_WITH(run_foot_proof_study(options), Catch::Contains("--force"));
}

TEST_CASE("an unknown case is refused with those that there are") {
  FootProofOptions options;
  options.only = {"toe-plai"};
  CHECK_THROWS_WITH(run_foot_proof_study(options), Catch::Contains("toe-play"));
}
