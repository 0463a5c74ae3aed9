// Sessions of the foot as a rig: what is predicted, and proof by ablation that a physics hidden in
// the plant is told from its rivals by the bus alone.
#include "tools/diagnose/foot_model.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/experiment/program.h"
#include "tools/diagnose/fitter.h"
#include "tools/run/errors.h"

using namespace hoof::tools;
using hoof::tests::run_program;
using hoof::tests::ScratchFolder;
namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

namespace {

/// Sessions that the program recorded, and data sets of them.
class Bench {
 public:
  /// @param hidden TOML of effects to conceal; "" for a nominal plant
  void record(const std::string& name, const std::string& hidden, Strings arguments) {
    const auto path = [this](const std::string& file) { return (folder_.path() / file).string(); };
    arguments.insert(arguments.end(),
                     {"--terrain", "rft", "--quiet", "--force", "--out", path(name)});
    if (!hidden.empty()) {
      write_file(path(name + "-hidden.toml"), hidden);
      arguments.insert(arguments.end(), {"--effects", path(name + "-hidden.toml"), "--conceal",
                                         path(name + "-truth.toml")});
    }
    REQUIRE(run_program(arguments).status == 0);
  }

  FootModel model(const std::string& session, const std::string& setup = "") const {
    const fs::path file = folder_.path() / "set.toml";
    write_file(file, "format = 1\nname = \"t\"\nrig = \"foot_hil\"\n" + setup +
                         "\n[[recording]]\nsession = \"" + session + "\"\nrole = \"fit\"\n");
    return FootModel({read_data_set(file)});
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

 private:
  ScratchFolder folder_;
};

std::string hidden(const std::string& effect, const std::string& keys) {
  return "format = 1\n[effects." + effect + "]\n" + keys;
}

const hoof::sim::EffectInfo* effect_of(const FootModel& model, const std::string& name) {
  for (const auto* info : model.effects()) {
    if (info->name == name) return info;
  }
  FAIL(name + " is no hypothesis of this model");
  return nullptr;
}

std::vector<double> stated(const FootModel& model) {
  std::vector<double> values;
  for (const DoubtfulValue& doubt : model.doubtful()) values.push_back(doubt.value);
  return values;
}

/// Root mean square of what is left, by channel.
std::map<std::string, double> left(const FootModel& model, const std::vector<ActiveEffect>& added) {
  const Prediction told = model.predict(0, stated(model), added, Rollout::kFree);
  std::map<std::string, double> rmse;
  for (std::size_t c = 0; c < told.size(); ++c) {
    const std::string& name = model.channels(0)[c];
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < told[c].size(); ++i) {
      const double d = model.recording(0).channels.at(name)[i] - told[c][i];
      if (std::isfinite(d)) sum += d * d, count += 1;
    }
    rmse[name] = std::sqrt(sum / count);
  }
  return rmse;
}

/// A rival at its best: over its starts, each at several sizes, then by trial on each parameter.
ActiveEffect at_its_best(const FootModel& model, const Fitter& fitter, const std::string& name) {
  const Effects effects = {effect_of(model, name)};
  const Layout layout(model, effects);
  Fit nominal;
  nominal.x = Layout(model, {}).stated();
  const auto weights = fitter.roomy_weights(fitter.squares(nominal), 0.3);
  Eigen::VectorXd best;
  double least = 1e300;
  for (const Layout::Start& start : layout.starts(nominal.x)) {
    for (const double scale : {0.5, 1.0, 2.0}) {
      Eigen::VectorXd x = start.x;
      if (start.size_coordinate >= 0) x[start.size_coordinate] += std::log(scale);
      const double objective = fitter.objective(effects, x, weights);
      if (objective < least) least = objective, best = x;
      if (start.size_coordinate < 0) break;
    }
  }
  // Without slopes: the firmware's codes and events make the squares ragged.
  for (double step = 0.2; step > 0.004;) {
    bool better = false;
    for (Eigen::Index i = layout.setup_count(); i < best.size(); ++i) {
      for (const double side : {-1.0, 1.0}) {
        Eigen::VectorXd x = best;
        x[i] += side * step;
        const double objective = fitter.objective(effects, x, weights);
        if (objective < least) least = objective, best = x, better = true;
      }
    }
    if (!better) step *= 0.4;
  }
  return layout.active(best).front();
}

}  // namespace

TEST_CASE("a session is predicted to the last bit, from its orders alone") {
  Bench bench;
  const bool gait = GENERATE(false, true);
  bench.record(
      "s", "",
      gait ? Strings{"traction", "--frequency", "1.1"} : Strings{"sinkage", "--toe", "30"});
  const FootModel model = bench.model("s");
  const auto& channels = model.channels(0);
  const auto has = [&channels](const char* name) {
    return std::find(channels.begin(), channels.end(), name) != channels.end();
  };
  CHECK(has("toe_torque"));
  CHECK(has("ground_fz"));
  CHECK(has("hip_position") == gait);
  CHECK(has("depth") == !gait);
  for (const auto& [channel, rmse] : left(model, {})) {
    INFO(channel);
    CHECK(rmse == 0);
  }
  // In two threads at once as in one.
  std::vector<Prediction> told(4);
  for_each_task(4, 2, [&](int i) {
    told[std::size_t(i)] = model.predict(0, stated(model), {}, Rollout::kFree);
  });
  for (const Prediction& p : told) {
    CHECK(p[0].back() == told[0][0].back());
    CHECK(p.back() == told[0].back());
  }
}

TEST_CASE("hypotheses are each at one joint that has a drive; doubts are the setup's") {
  Bench bench;
  bench.record("s", "", {"sinkage"});
  const FootModel model = bench.model("s", "[setup]\ntoe_coulomb = { value = 0.5, sigma = 0.1 }\n");
  effect_of(model, "backlash@toe");
  effect_of(model, "spine_wear");
  effect_of(model, "cohesion");
  for (const auto* info : model.effects()) {
    INFO(info->name);
    CHECK(joint_of_effect(info->name) != "hip");
    CHECK(plain_effect_name(info->name) != "supply_sag");
    CHECK(plain_effect_name(info->name) != "rig_compliance");
  }
  REQUIRE(model.doubtful().size() == 2);
  CHECK(model.doubtful()[0].name == "toe_coulomb");
  CHECK(model.doubtful()[1].name == "soil_stiffness");  // as its fit tells
  // The doubtful number is the plant's: the torque of an opening toe follows it.
  auto more = stated(model);
  more[0] += 0.3;
  const Prediction before = model.predict(0, stated(model), {}, Rollout::kFree);
  CHECK(model.predict(0, more, {}, Rollout::kFree) != before);
}

TEST_CASE("by ablation: play of the toes hides in a sinkage test, and nothing else explains it") {
  Bench bench;
  bench.record("s", hidden("backlash", "gap = 0.012\njoint = \"toe\"\n"), {"sinkage"});
  const FootModel model = bench.model("s");
  const Fitter fitter(model);
  const auto before = left(model, {});
  CHECK(before.at("depth") < 1e-6);  // the foot sinks as ever
  CHECK(before.at("toe_torque") > 0.1);

  const ActiveEffect play = at_its_best(model, fitter, "backlash@toe");
  const auto after = left(model, {play});
  CHECK(play.values[0] == Approx(0.012).epsilon(0.05));
  CHECK(after.at("toe_torque") < 0.3 * before.at("toe_torque"));
  CHECK(after.at("toe_position") < 0.1 * before.at("toe_position"));
  for (const char* rival : {"joint_compliance@toe", "transport_delay@toe",
                            "load_dependent_friction@toe", "spine_wear"}) {
    const auto rest = left(model, {at_its_best(model, fitter, rival)});
    INFO(rival << " leaves " << rest.at("toe_torque") << " Nm, play " << after.at("toe_torque"));
    CHECK(rest.at("toe_torque") > 2 * after.at("toe_torque"));
  }

  // A run with what was found is the session; without it the difference is back.
  write_file(bench.path("improved.toml"),
             hidden("backlash", "gap = " + std::to_string(play.values[0]) + "\njoint = \"toe\"\n"));
  const auto difference = [&](const Strings& more) {
    Strings arguments = {
        "sinkage", "--terrain", "rft", "--quiet", "--force", "--out", bench.path("again").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    REQUIRE(run_program(arguments).status == 0);
    const FootSession again = read_foot_session(bench.path("again"));
    const auto& told = again.signals.channel("toe_position");
    const auto& recorded = model.recording(0).channels.at("toe_position");
    double sum = 0;
    for (std::size_t i = 0; i < std::min(told.size(), recorded.size()); ++i) {
      if (std::isfinite(told[i] - recorded[i])) sum += std::pow(told[i] - recorded[i], 2);
    }
    return std::sqrt(sum / double(recorded.size()));
  };
  const double improved = difference({"--effects", bench.path("improved.toml").string()});
  CHECK(improved < 0.1 * difference({}));
}

TEST_CASE("by ablation: friction by load at the hip, which the position loop hides") {
  Bench bench;
  bench.record("s", hidden("load_dependent_friction", "coefficient = 0.08\njoint = \"hip\"\n"),
               {"traction", "--frequency", "1.1"});
  const FootModel model = bench.model("s");
  const Fitter fitter(model);
  const auto before = left(model, {});
  CHECK(before.at("hip_position") < 5e-4);
  CHECK(before.at("hip_torque") > 2);
  const ActiveEffect friction = at_its_best(model, fitter, "load_dependent_friction@hip");
  const auto after = left(model, {friction});
  CHECK(friction.values[0] == Approx(0.08).epsilon(0.03));
  CHECK(after.at("hip_torque") < 0.1 * before.at("hip_torque"));
  for (const char* rival :
       {"directional_friction@hip", "stribeck_friction@hip", "load_dependent_friction@knee"}) {
    const auto rest = left(model, {at_its_best(model, fitter, rival)});
    INFO(rival << " leaves " << rest.at("hip_torque") << " Nm");
    CHECK(rest.at("hip_torque") > 3 * after.at("hip_torque"));
  }
}

TEST_CASE("the verdict has the contract's names, the joint beside") {
  Verdict verdict;
  verdict.probabilities = {{"none", 0.1},
                           {"backlash@hip", 0.2},
                           {"backlash@toe", 0.5},
                           {"unknown", 0.0},
                           {"spine_wear", 0.2}};
  verdict.effects = {{"backlash@toe", 0.5, {}}, {"backlash@hip", 0.2, {}}, {"spine_wear", 0.2, {}}};
  verdict.named = {"backlash@toe"};
  verdict.not_separable = {{"backlash@toe", "backlash@hip", "spine_wear"}};
  verdict.ablation = {{"nominal + backlash@toe+spine_wear, backlash@toe taken away", {}, {}}};
  name_joints(verdict);
  CHECK(verdict.probabilities.at("backlash") == Approx(0.7));
  CHECK(verdict.probabilities.size() == 4);
  REQUIRE(verdict.effects.size() == 2);
  CHECK(verdict.effects[0].joint == "toe");
  CHECK(verdict.effects[0].probability == Approx(0.7));
  CHECK(verdict.named == Strings{"backlash"});
  CHECK(verdict.not_separable.front() == Strings{"backlash", "spine_wear"});
  CHECK(verdict.ablation.front().model == "nominal + backlash+spine_wear, backlash taken away");
}

TEST_CASE("sessions that cannot be replayed are refused with the reason") {
  Bench bench;
  bench.record("p", "", {"traction", "--drive", "prescribed", "--frequency", "1.1"});
  CHECK_THROWS_WITH(bench.model("p"), Catch::Contains("moved as prescribed"));
  bench.record("s", "", {"sinkage"});
  write_file(bench.path("s") / "bus.log", "");
  CHECK_THROWS_AS(bench.model("s"), UserError);
}
