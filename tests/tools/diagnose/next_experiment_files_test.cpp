// next_experiment.toml and next_experiment.csv, and their place in the answer and the report.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/diagnose/bench.h"
#include "tests/tools/diagnose/data_files.h"
#include "tests/tools/diagnose/sample_verdict.h"
#include "tools/diagnose/experiment_candidates.h"
#include "tools/diagnose/experiment_text.h"
#include "tools/diagnose/report_page.h"
#include "tools/diagnose/report_plots.h"
#include "tools/diagnose/verdict_json.h"
#include "tools/diagnose/write_answer.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace fs = std::filesystem;
using namespace hoof::tools;
using namespace hoof::tests;

namespace {

/// A made-up plan: the soft loop and the double payload of a bench, two hypotheses a little apart.
PlannedExperiment sample_plan(const DataSet& bench) {
  PlannedExperiment plan;
  plan.action = "hold 0.5 rad";
  plan.set = bench;
  plan.set.noise = {{"position", 0.001}};
  Recording& r = plan.set.recordings.front();
  r.name = kRecordedFile;
  r.planned = true;
  r.setup.values["payload_mass"] = {1.0, 0.05};
  r.setup.values["kp"] = {4, 0};
  plan.input_channels = {"position_goal"};
  plan.output_channels = {"position", "velocity", "torque"};
  const std::size_t count = r.time_s.size();
  for (const char* name : {"supply_sag", "backlash+stribeck_friction"}) {
    ExpectedOutcome o{name, {}, {}, 0.1, 0.002};
    const double level = plan.outcomes.empty() ? 0.1 : 0.2;
    o.predicted["position"].assign(count, level);
    o.spread["position"].assign(count, 0.01);
    o.reading = level;
    plan.outcomes.push_back(o);
  }
  plan.noise = {{"position", 0.001}};
  plan.telling = {"position", 1, 2, true, 0, 0.5, 12};
  plan.sigmas = 34;
  plan.log10_odds = 4.3;
  plan.again_sigmas = 0.7;
  plan.looked_at = 30;
  return plan;
}

std::string file_text(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("next_experiment.toml is a data set once what it asks for is recorded") {
  const DataFolder folder;
  const PlannedExperiment plan = sample_plan(pendulum_bench({.length_s = 3}));
  const auto toml = folder.write(kExperimentFile, experiment_toml(plan, {"a.toml", "b.toml"}));
  folder.write(kExperimentTable, experiment_csv(plan));
  // Nothing of what is to be recorded stands there to be taken for a recording.
  CHECK(experiment_csv(plan).starts_with("time,position_goal\n0,"));
  CHECK(file_text(toml).find("hoof diagnose a.toml b.toml next_experiment.toml") !=
        std::string::npos);
  try {
    read_data_set(toml);
    FAIL("read without a recording");
  } catch (const UserError& error) {
    CHECK(std::string(error.what()).find("no such file") != std::string::npos);
  }
  // As the rig recorded it.
  std::string csv = "time,position_goal,position,velocity,torque\n";
  const Recording& played = plan.set.recordings.front();
  for (std::size_t i = 0; i < played.time_s.size(); ++i) {
    csv += format_number(played.time_s[i]) + "," +
           format_number(played.channels.at("position_goal")[i]) + ",0.1,0.2,0.3\n";
  }
  folder.write(kRecordedFile, csv);
  const DataSet read = read_data_set(toml);
  CHECK(read.rig == RigKind::kServoPendulum);
  CHECK(read.noise == plan.set.noise);
  REQUIRE(read.recordings.size() == 1);
  const Recording& r = read.recordings.front();
  CHECK_FALSE(r.planned);
  CHECK_FALSE(r.holdout);
  CHECK(r.time_s == played.time_s);
  CHECK(r.channels.at("position_goal") == played.channels.at("position_goal"));
  CHECK(r.setup.law == DriveLaw::kImpedance);
  REQUIRE(r.setup.values.size() == played.setup.values.size());
  for (const auto& [key, v] : played.setup.values) {
    INFO(key);
    REQUIRE(r.setup.find(key) != nullptr);
    CHECK(r.setup.find(key)->value == v.value);
    CHECK(r.setup.find(key)->sigma == v.sigma);
  }
  // What is shared with the first data set stays shared: only what differs is this recording's.
  CHECK(read.setup.find("payload_mass")->value == 0.5);
  CHECK(file_text(toml).find("setup = { kp = 4, payload_mass = { value = 1, sigma = 0.05 } }") !=
        std::string::npos);
}

TEST_CASE("next_experiment: one sentence says what to do, what to read and what it means") {
  const DataSet bench = pendulum_bench({.length_s = 3});
  PlannedExperiment plan = sample_plan(bench);
  CHECK(experiment_sentence(plan) ==
        "hold 0.5 rad (next_experiment.csv): the change of position, mean from 1 to 2 s less mean "
        "from 0 to 0.5 s, then tells, where 0.1 +- 0.002 rad means supply_sag and 0.2 +- 0.002 rad "
        "means backlash+stribeck_friction; over the whole recording they are 34 sigma apart, what "
        "is uncertain of both allowed for (20000 to one to be expected), against 0.7 if the best "
        "of the recordings given were made again");
  plan.telling = {"position", 1.5, 1.5, false, 0, 0, 1.2};
  plan.outcomes.push_back(plan.outcomes[1]);
  plan.outcomes[2].hypothesis = "none";
  plan.log10_odds = 9;
  const std::string text = experiment_sentence(plan);
  CHECK(text.find("position at 1.5 s then differs most, where") != std::string::npos);
  CHECK(text.find(", 0.2 +- 0.002 rad means backlash+stribeck_friction and 0.2 +- 0.002 rad means "
                  "nothing missing; over the whole recording the nearest two are") !=
        std::string::npos);
  CHECK(text.find("(more than a million to one to be expected)") != std::string::npos);
}

TEST_CASE("next_experiment files stand in the answer while it is open, and go when it is not") {
  const DataFolder folder;
  const auto out = folder.path() / "answer";
  const DataSet bench = pendulum_bench({.length_s = 3});
  Verdict verdict = sample_verdict_not_separable();
  verdict.planned_experiment = sample_plan(bench);
  const auto answer = [&] {
    AnswerFolder open(out, kVerdictFile, true);
    write_answer(verdict, sample_data_sets(), open);
  };
  answer();
  CHECK(file_text(out / kExperimentTable) == experiment_csv(*verdict.planned_experiment));
  CHECK(file_text(out / kExperimentFile).find("bench/arm.toml next_experiment.toml") !=
        std::string::npos);
  const auto json = nlohmann::json::parse(file_text(out / kVerdictFile));
  CHECK(json["planned_experiment"]["sigmas"] == 34);
  CHECK(json["planned_experiment"]["outcomes"][1]["reading"] == 0.2);
  CHECK(json["planned_experiment"]["reading"]["less"]["end"] == 0.5);
  verdict.planned_experiment.reset();
  answer();
  CHECK_FALSE(fs::exists(out / kExperimentTable));
  CHECK_FALSE(fs::exists(out / kExperimentFile));
  CHECK_FALSE(nlohmann::json::parse(file_text(out / kVerdictFile)).contains("planned_experiment"));
}

TEST_CASE("A report shows what each hypothesis expects of the next experiment") {
  const DataSet bench = pendulum_bench({.length_s = 3});
  Verdict verdict = sample_verdict_not_separable();
  const auto plots = [&] {
    return nlohmann::json::parse(report_plots(verdict, bench.rig).json)["plots"];
  };
  const std::size_t before = plots().size();
  CHECK(report_plots(verdict, bench.rig).planned_html.empty());
  verdict.planned_experiment = sample_plan(bench);
  const auto all = plots();
  REQUIRE(all.size() == before + 2);
  const auto& signal = all[before];
  CHECK(signal["series"][0]["label"] == "supply_sag");
  CHECK(signal["series"][1]["values"][3] == 0.2);
  REQUIRE(signal["regions"].size() == 2);
  CHECK(signal["regions"][1]["from_s"] == 1);
  const auto& difference = all[before + 1];
  REQUIRE(difference["series"].size() == 3);
  CHECK(difference["series"][0]["band"] == true);
  // 2 sqrt(0.001^2 + 2 0.01^2)
  CHECK(difference["series"][0]["values"][0].get<double>() ==
        Approx(2 * std::sqrt(2.01e-4)).epsilon(1e-3));
  CHECK(difference["series"][1]["values"][0].get<double>() == Approx(0.1));
  const std::string page = report_page(verdict, sample_data_sets());
  CHECK(page.find("What next") < page.find("next experiment: position"));
  CHECK(page.find("Chosen among 30") != std::string::npos);
}
