// verdict.json, improved.toml and the tables: what is written can be read, by the contract.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/tools/diagnose/data_files.h"
#include "tests/tools/diagnose/sample_verdict.h"
#include "tools/diagnose/answer_folder.h"
#include "tools/diagnose/answer_tables.h"
#include "tools/diagnose/effects_file.h"
#include "tools/diagnose/verdict_json.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"

using namespace hoof::tools;
using namespace hoof::tests;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  return keys;
}

using Words = std::vector<std::string>;

std::string complaint(const fs::path& file, const DataFolder& folder) {
  try {
    read_effects_file(file);
    return "(read without complaint)";
  } catch (const UserError& error) {
    return folder.shortened(error.what());
  }
}

}  // namespace

TEST_CASE("verdict.json has the keys of the contract in its order") {
  const Json json = Json::parse(result_json_text(verdict_json(sample_verdict_unknown())));
  CHECK(keys_of(json) == Words{"format", "verdict", "probabilities", "effects", "not_separable",
                               "next_experiment", "where", "fit", "ablation", "unknown_term",
                               "setup", "data_quality"});
  CHECK(json["format"].is_number_integer());
  CHECK(keys_of(json["where"]) == Words{"channels", "recordings", "intervals", "condition"});
  CHECK(keys_of(json["where"]["intervals"][0]) == Words{"recording", "start", "end"});
  CHECK(keys_of(json["fit"]) == Words{"before", "after", "noise_floor"});
  CHECK(keys_of(json["fit"]["before"]) == Words{"fit", "holdout"});
  CHECK(keys_of(json["ablation"][0]) == Words{"model", "holdout"});
  CHECK(keys_of(json["unknown_term"]) == Words{"inputs", "form", "residual_share", "holdout"});
  CHECK(keys_of(json["effects"][0]) == Words{"name", "probability", "parameters"});
  CHECK(keys_of(json["effects"][0]["parameters"]["amplitude"]) == Words{"value", "unit", "ci95"});
  const Json found = verdict_json(sample_verdict());
  CHECK(found["unknown_term"].is_null());
  CHECK(keys_of(found["probabilities"]) ==
        Words{"none", "unknown", "cogging_torque", "backlash", "stribeck_friction", "supply_sag"});
}

TEST_CASE("verdict.json says exactly what the verdict says") {
  Verdict v = sample_verdict();
  v.effects[0].parameters[0].value = 0.1 + 0.2;  // 17 digits
  v.before.fit["position_rmse"] = 1.0 / 3;
  const Json json = Json::parse(result_json_text(verdict_json(v)));
  const Json& cogging = json["effects"][0];
  CHECK(cogging["name"] == "cogging_torque");
  CHECK(cogging["parameters"]["amplitude"]["value"].get<double>() == 0.1 + 0.2);
  CHECK(cogging["parameters"]["amplitude"]["unit"] == "Nm");
  CHECK(cogging["parameters"]["amplitude"]["ci95"] == Json::array({0.027, 0.035}));
  CHECK(json["fit"]["before"]["fit"]["position_rmse"].get<double>() == 1.0 / 3);
  CHECK(json["fit"]["after"]["holdout"]["position_rmse"].get<double>() == 0.0044);
  CHECK(json["where"]["intervals"][1]["end"].get<double>() == 5.8);
  CHECK(json["probabilities"]["unknown"].get<double>() == 0.02);
  CHECK(json["ablation"][2]["model"] == "nominal + backlash");
  CHECK(json["setup"]["arm_mass"]["after"].get<double>() == 0.0155);
  CHECK(json["data_quality"][1]["serious"] == true);
  CHECK(result_json_text(verdict_json(v)) == result_json_text(verdict_json(v)));
}

TEST_CASE("verdict.json lists effects from a probability of 0.01 on, and the named ones always") {
  const auto names = [](const Verdict& v) {
    Words words;
    const Json json = verdict_json(v);
    for (const Json& effect : json["effects"]) words.push_back(effect["name"]);
    return words;
  };
  Verdict v = sample_verdict();
  CHECK(names(v) == Words{"cogging_torque", "backlash", "stribeck_friction"});
  v.effects[1].probability = 0.01;
  v.effects[2].probability = 0.0099;
  CHECK(names(v) == Words{"cogging_torque", "backlash"});
  v.named = {"supply_sag"};
  CHECK(names(v) == Words{"cogging_torque", "backlash", "supply_sag"});
}

TEST_CASE("verdict.json never holds what is no number") {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  Verdict v = sample_verdict();
  v.before.holdout["position_rmse"] = infinity;
  v.after.holdout["velocity_rmse"] = nan;
  v.effects[0].parameters[0].low95 = -infinity;
  v.effects[0].parameters[0].high95 = nan;
  const Json json = verdict_json(v);
  CHECK(json["fit"]["before"]["holdout"].empty());
  CHECK(keys_of(json["fit"]["after"]["holdout"]) == Words{"position_rmse"});
  const hoof::sim::EffectInfo* info = hoof::sim::find_effect("cogging_torque");
  REQUIRE(info != nullptr);
  CHECK(json["effects"][0]["parameters"]["amplitude"]["ci95"] ==
        Json::array({info->parameters[0].low, info->parameters[0].high}));
  CHECK_NOTHROW(result_json_text(json));
  v.effects[0].parameters[0].value = nan;
  CHECK_THROWS_AS(result_json_text(verdict_json(v)), CannotFinish);
}

TEST_CASE("improved.toml is read as it was written") {
  const DataFolder folder;
  Verdict v = sample_verdict();
  v.effects[0].parameters[0].value = 0.1 + 0.2;
  v.setup.push_back({"kp_duty@a \"b\".csv", 100, 5, 101, 102.5});
  const std::string text = effects_file_text(v, {"arm\n# on", "bench"});
  CHECK_THAT(text, Catch::StartsWith("# The model that hoof diagnose found for arm # on, bench."));
  const EffectsFile file = read_effects_file(folder.write("improved.toml", text));
  REQUIRE(file.effects.size() == 1);
  CHECK(file.effects[0].info == hoof::sim::find_effect("cogging_torque"));
  CHECK(file.effects[0].values == std::vector<double>{0.1 + 0.2, 8, 0.4});
  CHECK(file.setup == std::map<std::string, double>{{"arm_mass", 0.0155},
                                                    {"coulomb", 0.034},
                                                    {"kp_duty@a \"b\".csv", 102.5}});
  // Nothing missing: the refitted setup alone.
  const EffectsFile none = read_effects_file(
      folder.write("none.toml", effects_file_text(sample_verdict_none(), {"arm"})));
  CHECK(none.effects.empty());
  CHECK(none.setup.size() == 2);
}

TEST_CASE("A malformed improved.toml gets a line that names its place") {
  const DataFolder folder;
  const std::string sound =
      "format = 1\n[setup]\narm_mass = 0.02\n"
      "[effects.cogging_torque]\namplitude = 0.03\norder = 8\nphase = 0.4\n";
  CHECK(complaint(folder.write("f.toml", sound), folder) == "(read without complaint)");
  struct Case {
    std::string from, to, message;
  };
  const std::vector<Case> cases = {
      {"format = 1", "", "f.toml: format: missing; must be 1"},
      {"[setup]", "[setupp]", "f.toml:2:2: setupp = {a table}: unknown key, did you mean setup?"},
      {"0.02", "\"x\"", "f.toml:3:1: setup.arm_mass = \"x\": must be a finite number"},
      {"0.02", "nan", "f.toml:3:1: setup.arm_mass = nan: must be a finite number"},
      {"cogging_torque", "coging_torque",
       "f.toml:4:10: effects.coging_torque = {a table}: unknown effect, did you mean "
       "cogging_torque?"},
      {"amplitude", "amplitud",
       "f.toml:5:1: effects.cogging_torque.amplitud = 0.03: unknown parameter of cogging_torque, "
       "did you mean amplitude?"},
      {"order = 8\n", "",
       "f.toml:4:1: effects.cogging_torque.order: missing; must be a finite number"},
      {"order = 8", "order = 0",
       "f.toml:6:1: effects.cogging_torque.order = 0: must be from 1 to 120 1/rev"},
      {"amplitude = 0.03", "amplitude = -0.03",
       "f.toml:5:1: effects.cogging_torque.amplitude = -0.03: must be from 0 to 1000 Nm"},
      {"amplitude = 0.03", "amplitude = inf",
       "f.toml:5:1: effects.cogging_torque.amplitude = inf: must be a finite number"},
      {"[effects.cogging_torque]", "[effects]\ncogging_torque = 3\n[x]",
       "f.toml:6:2: x = {a table}: unknown key; allowed: format, setup, effects"}};
  for (const Case& c : cases) {
    INFO("written: " << c.to);
    CHECK(complaint(folder.write("f.toml", replaced(sound, c.from, c.to)), folder) == c.message);
  }
}

TEST_CASE("The tables beside the verdict quote what needs it and keep every digit") {
  Verdict v = sample_verdict();
  v.hypotheses.resize(1);
  v.hypotheses[0].name = "a, \"b\"";
  v.hypotheses[0].evidence = 0.1 + 0.2;
  CHECK(hypotheses_csv(v.hypotheses) ==
        "name,parameters_count,log_likelihood,samples_count,evidence,holdout_gain,probability\n"
        "\"a, \"\"b\"\"\",9,5210.5,1600,0.30000000000000004,301.5,0.9\n");
  ChannelTrace t{"a.csv", "position", true, {0, 0.5}, {1, std::nan("")}, {0.5, 2}, {0.75, 3}};
  CHECK(residuals_csv({t}) ==
        "recording,role,channel,time,measured,before,after,residual_before,residual_after\n"
        "a.csv,holdout,position,0,1,0.5,0.75,0.5,0.25\n"
        "a.csv,holdout,position,0.5,nan,2,3,nan,nan\n");
}

TEST_CASE("An answer stands whole or not at all, and spares what else is in the folder") {
  const DataFolder scratch;
  const fs::path out = scratch.path() / "deep/er/out";
  {
    AnswerFolder folder(out, "last.json", false);
    folder.write("first.txt", "1");
    CHECK_FALSE(fs::exists(out / "first.txt"));
  }
  CHECK_FALSE(fs::exists(out));
  scratch.write("deep/er/out/log.txt", "kept");
  scratch.write("deep/er/out/.hoof-partial-1/half", "of a run that was killed");
  {
    AnswerFolder folder(out, "last.json", false);
    CHECK_FALSE(fs::exists(out / ".hoof-partial-1"));
    folder.write("last.json", "2");
    folder.write("first.txt", "1");
    folder.commit();
  }
  CHECK(read_file(out / "last.json") == "2");
  CHECK(read_file(out / "first.txt") == "1");
  CHECK(std::distance(fs::directory_iterator(out), fs::directory_iterator()) == 3);
  CHECK_THROWS_WITH(AnswerFolder(out, "last.json", false),
                    "--out " + out.string() + ": holds an earlier last.json (--force replaces it)");
  AnswerFolder folder(out, "last.json", true);
  folder.write("last.json", "3");
  CHECK(read_file(out / "last.json") == "2");
  folder.commit();
  CHECK(read_file(out / "last.json") == "3");
  CHECK(read_file(out / "log.txt") == "kept");
  scratch.write("file", "");
  CHECK_THROWS_WITH(AnswerFolder(scratch.path() / "file", "x", false),
                    Catch::EndsWith("file: is not a folder"));
}

TEST_CASE("Each kind of verdict has its sentence and ten lines") {
  CHECK_THAT(headline(sample_verdict()),
             Catch::StartsWith("The model lacks cogging_torque (probability 0.90): a torque that"));
  CHECK(headline(sample_verdict_none()) ==
        "The model explains these recordings; nothing is missing (probability 0.97).");
  CHECK(headline(sample_verdict_unknown()) ==
        "The model lacks something that no known effect explains (probability 0.93); it goes with "
        "position, velocity.");
  CHECK(headline(sample_verdict_not_separable()) ==
        "These recordings cannot tell which it is: supply_sag (0.50) or thermal_derating (0.48).");
  for (const Verdict& v : {sample_verdict(), sample_verdict_none(), sample_verdict_unknown(),
                           sample_verdict_not_separable()}) {
    CHECK(summary_lines(v, RigKind::kServoPendulum, "runs/x").size() == 10);
  }
  const Words lines = summary_lines(sample_verdict(), RigKind::kServoPendulum, "runs/x");
  CHECK(lines[1] ==
        "parameters  amplitude 0.031 Nm (95 %: 0.027 to 0.035); order 8 1/rev (95 %: 8 to 8); "
        "phase 0.4 rad (95 %: 0.31 to 0.49)");
  CHECK(lines[2] ==
        "where       position where |velocity| < 0.2; slow_triangle.csv 2.1 to 3.9 s, "
        "slow_triangle.csv 5 to 5.8 s");
  CHECK(lines[3] == "held out    position 0.0362 -> 0.0044 rad (noise floor 0.0014)");
  CHECK(lines[5] == "else        backlash 0.04, stribeck_friction 0.02, unknown 0.02, none 0.01");
}
