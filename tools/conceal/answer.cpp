#include "tools/conceal/answer.h"

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools::conceal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::map<std::string, double> numbers(const Json& fit, const char* stage) {
  std::map<std::string, double> out;
  if (!fit.contains(stage) || !fit.at(stage).contains("holdout")) return out;
  for (const auto& [key, value] : fit.at(stage).at("holdout").items()) {
    if (value.is_number()) out[key] = value;
  }
  return out;
}

AnsweredEffect effect_of(const Json& json) {
  AnsweredEffect effect{json.at("name"), json.value("probability", 0.0), {}};
  if (!json.contains("parameters")) return effect;
  for (const auto& [name, p] : json.at("parameters").items()) {
    const Json& ci = p.at("ci95");
    if (!ci.is_array() || ci.size() != 2 || !ci[0].is_number() || !ci[1].is_number()) continue;
    effect.parameters[name] = {p.at("value"), ci[0], ci[1]};
  }
  return effect;
}

Answer answer_of(const Json& json) {
  Answer a;
  a.verdict = json.at("verdict");
  for (const auto& [name, p] : json.at("probabilities").items()) a.probabilities[name] = p;
  for (const Json& effect : json.at("effects")) a.effects.push_back(effect_of(effect));
  a.not_separable = json.value("not_separable", std::vector<std::vector<std::string>>{});
  const Json where = json.value("where", Json::object());
  a.channels = where.value("channels", std::vector<std::string>{});
  const Json intervals = where.value("intervals", Json::array());
  for (const Json& i : intervals) {
    a.intervals.push_back({i.at("recording"), i.at("start"), i.at("end")});
  }
  const Json fit = json.value("fit", Json::object());
  a.holdout_before = numbers(fit, "before");
  a.holdout_after = numbers(fit, "after");
  return a;
}

std::vector<AnsweredHypothesis> read_hypotheses(const fs::path& file) {
  std::vector<AnsweredHypothesis> out;
  if (!fs::exists(file)) return out;
  std::istringstream lines(read_file(file));
  std::string line;
  std::getline(lines, line);
  if (line != "name,parameters_count,log_likelihood,samples_count") {
    throw UserError(file.string() +
                    ":1: columns name,parameters_count,log_likelihood,"
                    "samples_count are expected, not " +
                    line);
  }
  for (int at = 2; std::getline(lines, line); ++at) {
    if (line.empty()) continue;
    AnsweredHypothesis h;
    std::istringstream cells(line);
    char comma = 0;
    if (!std::getline(cells, h.name, ',') ||
        !(cells >> h.parameters_count >> comma >> h.log_likelihood >> comma >> h.samples_count)) {
      throw UserError(file.string() + ":" + std::to_string(at) + ": not a name and three numbers");
    }
    out.push_back(h);
  }
  return out;
}

}  // namespace

Answer read_answer(const fs::path& folder) {
  const fs::path file = folder / "verdict.json";
  Answer answer;
  try {
    answer = answer_of(Json::parse(read_file(file)));
  } catch (const Json::exception& e) {
    throw UserError(file.string() + ": " + e.what());
  }
  answer.hypotheses = read_hypotheses(folder / "hypotheses.csv");
  if (fs::exists(folder / "seconds.txt")) {
    answer.seconds = std::strtod(read_file(folder / "seconds.txt").c_str(), nullptr);
  }
  return answer;
}

}  // namespace hoof::tools::conceal
