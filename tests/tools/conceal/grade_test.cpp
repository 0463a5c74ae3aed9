// The whole grader on answers made from the truth, and on one who always says the same.

#include "tools/conceal/grade.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/run/scratch_folder.h"
#include "tools/conceal/make.h"
#include "tools/conceal/measures.h"
#include "tools/run/output_file.h"

using namespace hoof::tests;
using namespace hoof::tools;
using namespace hoof::tools::conceal;

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

Json none_answer() {
  return {{"format", 1},
          {"verdict", "none"},
          {"probabilities", {{"none", 1.0}}},
          {"effects", Json::array()},
          {"not_separable", Json::array()},
          {"where", {{"channels", Json::array()}, {"intervals", Json::array()}}}};
}

Json perfect_answer(const TruthCase& truth) {
  Json a = none_answer();
  if (truth.nothing_hidden()) return a;
  a["verdict"] = truth.kind == "unknown"         ? "unknown_physics"
                 : truth.kind == "not_decidable" ? "not_separable"
                                                 : "missing_physics";
  a["probabilities"] = {{label(truth), 1.0}};
  if (truth.kind == "not_decidable") a["not_separable"] = Json::array({Json(truth.alike)});
  for (const HiddenEffect& effect : truth.effects) {
    Json parameters = Json::object();
    for (const EffectParameter& p : effect.parameters) {
      parameters[p.name] = {{"value", p.value}, {"ci95", {0.99 * p.value, 1.01 * p.value}}};
      if (p.value < 0.0) parameters[p.name]["ci95"] = {1.01 * p.value, 0.99 * p.value};
    }
    if (effect.listed) {
      a["effects"].push_back(
          {{"name", effect.name}, {"probability", 1.0}, {"parameters", parameters}});
    }
  }
  a["where"]["channels"] = {truth.main_channel()};
  for (const TimeInterval& i : truth.intervals) {
    a["where"]["intervals"].push_back(
        {{"recording", i.recording}, {"start", i.start_s}, {"end", i.end_s}});
  }
  for (const auto& [key, value] : truth.holdout_rmse) {
    a["fit"]["before"]["holdout"][key] = 3.0 * value;
    a["fit"]["after"]["holdout"][key] = value;
  }
  return a;
}

/// A sealed batch of plates, made once: it takes some seconds.
struct Sealed {
  ScratchFolder scratch;
  std::vector<TruthCase> truths;

  Sealed() {
    MakeOptions options;
    options.seed = 2;
    options.count = 20;
    options.rig = "plate_sand";
    options.out = folder();
    options.quiet = true;
    make(options);
    truths = read_truth(folder() / "truth.json", folder() / "truth.sha256");
  }

  fs::path folder() const { return scratch.path() / "sealed"; }
};

const Sealed& sealed() {
  static const Sealed once;
  return once;
}

/// Answers to it.
struct Batch {
  ScratchFolder scratch;
  const std::vector<TruthCase>& truths = sealed().truths;

  fs::path folder() const { return sealed().folder(); }
  fs::path answers() const { return scratch.path() / "answers"; }

  void answer(const std::function<Json(const TruthCase&)>& one) const {
    for (const TruthCase& truth : truths) {
      fs::create_directories(answers() / truth.name);
      write_file(answers() / truth.name / "verdict.json", one(truth).dump());
      write_file(answers() / truth.name / "seconds.txt", "2.5\n");
    }
  }

  std::string graded() const {
    std::ostringstream out;
    GradeOptions options;
    options.batch = folder();
    options.answers = answers();
    options.csv = scratch.path() / "graded.csv";
    grade(options, out);
    return out.str();
  }
};

std::string line_of(const std::string& text, const std::string& start) {
  const std::size_t from = text.find("\n" + start);
  return from == std::string::npos ? ""
                                   : text.substr(from + 1, text.find('\n', from + 1) - from - 1);
}

}  // namespace

TEST_CASE("perfect answers reach every aim but the one that asks for intervals that miss") {
  const Batch batch;
  batch.answer(perfect_answer);
  const std::string text = batch.graded();
  CAPTURE(text);
  for (const char* measure :
       {"false alarms", "right name, one effect", "both named", "unknown_physics", "not_separable",
        "right channel", "overlap of intervals", "held-out error", "calibration error"}) {
    const std::string line = line_of(text, measure);
    CAPTURE(line);
    CHECK(line.ends_with(" aim"));
  }
  // All of them hold the truth: more than 95 % intervals may.
  CHECK(line_of(text, "95 % intervals").ends_with(" NOT MET"));
  CHECK(text.find("median 2.5 s, longest 2.5 s, 20 cases") != std::string::npos);
  CHECK(text.find("no answer") == std::string::npos);
  const std::string csv = read_file(batch.scratch.path() / "graded.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 21);
}

TEST_CASE("who always says none raises no alarm and finds nothing") {
  const Batch batch;
  batch.answer([](const TruthCase&) { return none_answer(); });
  const std::string text = batch.graded();
  CAPTURE(text);
  CHECK(line_of(text, "false alarms").ends_with(" aim"));
  for (const char* measure :
       {"right name, one effect", "both named", "unknown_physics", "not_separable", "right channel",
        "held-out error", "calibration error"}) {
    CHECK(line_of(text, measure).ends_with(" NOT MET"));
  }
  // Said 1.0 of none, right in 6 of the 19 cases that can be decided.
  CHECK(line_of(text, "calibration error").find("0.684") != std::string::npos);
}

TEST_CASE("a missing or malformed answer counts as wrong and is told") {
  const Batch batch;
  batch.answer(perfect_answer);
  fs::remove(batch.answers() / "case_0003" / "verdict.json");
  write_file(batch.answers() / "case_0004" / "verdict.json", "{\"verdict\": 3");
  const std::string text = batch.graded();
  CHECK(text.find("no answer, counted as wrong: ") != std::string::npos);
  CHECK(text.find("case_0003/verdict.json") != std::string::npos);
  CHECK(text.find("case_0004/verdict.json") != std::string::npos);
}

TEST_CASE("AIC and BIC are read from the list of hypotheses") {
  const Batch batch;
  batch.answer(perfect_answer);
  for (const TruthCase& truth : batch.truths) {
    write_file(batch.answers() / truth.name / "hypotheses.csv",
               "name,parameters_count,log_likelihood,samples_count\nnone,3,0,1000\n"
               "cohesion,4,3,1000\n");
  }
  const std::string text = batch.graded();
  const std::string beside = line_of(text, "beside it");
  CAPTURE(text);
  const std::string line = text.substr(text.find("beside it"));
  const std::string alarms = line_of(line, "false alarms");
  // diagnose 0, AIC names cohesion always, BIC never.
  CHECK(alarms.find("0.0 %    100.0 %      0.0 %") != std::string::npos);
}
