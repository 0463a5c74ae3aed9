#include "tools/diagnose/verdict_json.h"

#include <algorithm>
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;
constexpr double kLeastProbability = 0.01;

/// none, unknown, then the effects, most probable first.
Json probabilities_json(const std::map<std::string, double>& probabilities) {
  std::vector<std::pair<std::string, double>> order(probabilities.begin(), probabilities.end());
  const auto rank = [](const std::string& name) {
    return name == "none" ? 0 : name == "unknown" ? 1 : 2;
  };
  std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    if (rank(a.first) != rank(b.first)) return rank(a.first) < rank(b.first);
    return a.second > b.second;
  });
  Json json = Json::object();
  for (const auto& [name, probability] : order) json[name] = probability;
  return json;
}

/// The interval, cut at what the catalogue allows where it is open.
Json interval_json(const std::string& effect, const ParameterEstimate& estimate) {
  double low = estimate.low95, high = estimate.high95;
  if (const sim::EffectInfo* info = sim::find_effect(effect)) {
    for (const sim::EffectParameter& parameter : info->parameters) {
      if (parameter.name != estimate.name) continue;
      if (!std::isfinite(low)) low = parameter.low;
      if (!std::isfinite(high)) high = parameter.high;
    }
  }
  return Json::array({low, high});
}

Json effects_json(const Verdict& verdict) {
  Json json = Json::array();
  for (const EffectFinding& effect : verdict.effects) {
    const bool named =
        std::find(verdict.named.begin(), verdict.named.end(), effect.name) != verdict.named.end();
    if (!named && !(effect.probability >= kLeastProbability)) continue;
    Json parameters = Json::object();
    for (const ParameterEstimate& p : effect.parameters) {
      parameters[p.name] = {
          {"value", p.value}, {"unit", p.unit}, {"ci95", interval_json(effect.name, p)}};
    }
    json.push_back({{"name", effect.name},
                    {"probability", effect.probability},
                    {"parameters", std::move(parameters)}});
  }
  return json;
}

Json errors_json(const Errors& errors) {
  Json json = Json::object();
  for (const auto& [key, value] : errors) {
    if (std::isfinite(value)) json[key] = value;
  }
  return json;
}

Json role_errors_json(const RoleErrors& errors) {
  return {{"fit", errors_json(errors.fit)}, {"holdout", errors_json(errors.holdout)}};
}

Json where_json(const Verdict& verdict) {
  Json intervals = Json::array();
  for (const Interval& i : verdict.intervals) {
    intervals.push_back({{"recording", i.recording}, {"start", i.start_s}, {"end", i.end_s}});
  }
  return {{"channels", verdict.channels},
          {"recordings", verdict.recordings},
          {"intervals", std::move(intervals)},
          {"condition", verdict.condition}};
}

Json unknown_json(const std::optional<UnknownTerm>& term) {
  if (!term) return nullptr;
  return {{"inputs", term->inputs},
          {"form", term->form},
          {"residual_share", term->residual_share},
          {"holdout", errors_json(term->holdout)}};
}

Json planned_json(const PlannedExperiment& plan) {
  Json outcomes = Json::array();
  for (const ExpectedOutcome& o : plan.outcomes) {
    if (plan.open_loop) break;
    outcomes.push_back(
        {{"hypothesis", o.hypothesis}, {"reading", o.reading}, {"sigma", o.reading_sigma}});
  }
  const TellingReading& t = plan.telling;
  Json reading = {{"channel", t.channel}, {"start", t.from_s}, {"end", t.to_s}};
  if (t.change) reading["less"] = {{"start", t.earlier_from_s}, {"end", t.earlier_to_s}};
  reading["sigmas"] = t.sigmas;
  return {{"action", plan.action},         {"sigmas", plan.sigmas},
          {"log10_odds", plan.log10_odds}, {"sigmas_if_given_again", plan.again_sigmas},
          {"reading", std::move(reading)}, {"outcomes", std::move(outcomes)},
          {"looked_at", plan.looked_at}};
}

Json setup_json(const std::vector<SetupEstimate>& setup) {
  Json json = Json::object();
  for (const SetupEstimate& s : setup) {
    json[s.name] = {
        {"stated", s.stated}, {"sigma", s.sigma}, {"before", s.before}, {"after", s.after}};
  }
  return json;
}

Json quality_json(const std::vector<QualityNote>& notes) {
  Json json = Json::array();
  for (const QualityNote& n : notes) {
    json.push_back({{"recording", n.recording},
                    {"channel", n.channel},
                    {"serious", n.serious},
                    {"text", n.text}});
  }
  return json;
}

}  // namespace

Json verdict_json(const Verdict& verdict) {
  Json json;
  json["format"] = kFormat;
  json["verdict"] = verdict.verdict;
  json["probabilities"] = probabilities_json(verdict.probabilities);
  json["effects"] = effects_json(verdict);
  json["not_separable"] = verdict.not_separable;
  json["next_experiment"] = verdict.next_experiment;
  json["where"] = where_json(verdict);
  json["fit"] = {{"before", role_errors_json(verdict.before)},
                 {"after", role_errors_json(verdict.after)},
                 {"noise_floor", errors_json(verdict.noise_floor)}};
  json["ablation"] = Json::array();
  for (const AblationRow& row : verdict.ablation) {
    json["ablation"].push_back({{"model", row.model}, {"holdout", errors_json(row.holdout)}});
  }
  json["unknown_term"] = unknown_json(verdict.unknown_term);
  json["setup"] = setup_json(verdict.setup);
  json["data_quality"] = quality_json(verdict.quality);
  if (verdict.planned_experiment) {
    json["planned_experiment"] = planned_json(*verdict.planned_experiment);
  }
  return json;
}

}  // namespace hoof::tools
