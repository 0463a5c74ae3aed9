#include "tools/diagnose/next_experiment.h"

#include <algorithm>

#include "tools/diagnose/experiment_design.h"
#include "tools/diagnose/experiment_text.h"
#include "tools/diagnose/foot_effects.h"
#include "tools/report/display_unit.h"

namespace hoof::tools {
namespace {

/// A hypothesis less probable than this is no rival.
constexpr double kLeastRival = 0.1;
constexpr std::size_t kMostRivals = 4;
/// An experiment that is expected to give odds less than ten to one is not worth making.
constexpr double kWorthMaking = 1;

std::string experiment_of(const std::string& effect) {
  const sim::EffectInfo* info = sim::find_effect(plain_effect_name(effect));
  return info ? std::string(info->experiment) : "";
}

/// The catalogue's own words.
std::string words_of_catalogue(const Judgement& judgement, const Verdict& verdict) {
  std::string text;
  if (verdict.verdict == "not_separable") {
    for (const std::string& name : verdict.not_separable.front()) {
      const std::string one = experiment_of(name);
      if (!one.empty()) text += (text.empty() ? "" : "; and ") + one + " (shows " + name + ")";
    }
  } else if (verdict.verdict == "unknown_physics") {
    for (const Standing& s : judgement.standings) {
      if (s.listed || s.fit->effects.empty()) continue;
      text = std::string(s.fit->effects.front()->experiment);
      break;
    }
  }
  return text;
}

bool within(const Fit& fit, const std::vector<std::string>& names) {
  return std::all_of(fit.effects.begin(), fit.effects.end(), [&](const sim::EffectInfo* e) {
    return std::find(names.begin(), names.end(), e->name) != names.end();
  });
}

/// Members of the set that cannot be told apart: each by the most probable hypothesis that holds
/// it.
std::vector<Rival> rivals_of_set(const Judgement& judgement,
                                 const std::vector<std::string>& names) {
  std::vector<Rival> rivals;
  std::vector<std::string> left = names;
  for (const Standing& s : judgement.standings) {
    if (s.fit->effects.empty() || !s.listed || !within(*s.fit, names)) continue;
    bool brings = false;
    for (const sim::EffectInfo* e : s.fit->effects) {
      brings = std::erase(left, std::string(e->name)) > 0 || brings;
    }
    if (brings || s.probability >= kLeastRival) rivals.push_back({s.fit, s.probability});
  }
  return rivals;
}

/// Whoever is probable enough, the nominal model and stand-ins for unlisted physics too.
std::vector<Rival> probable_rivals(const Judgement& judgement) {
  std::vector<Rival> rivals;
  for (const Standing& s : judgement.standings) {
    if (s.probability >= kLeastRival) rivals.push_back({s.fit, s.probability});
  }
  return rivals;
}

/// The stand-in that fits best and the best of the list.
std::vector<Rival> rivals_of_unknown(const Judgement& judgement) {
  const Standing *stand_in = nullptr, *best = nullptr;
  for (const Standing& s : judgement.standings) {
    if (s.fit->effects.empty()) continue;
    const Standing*& first = s.listed ? best : stand_in;
    if (first == nullptr) first = &s;
  }
  if (stand_in == nullptr || best == nullptr) return {};
  return {{stand_in->fit, 0.5}, {best->fit, 0.5}};
}

std::vector<Rival> rivals_of(const Judgement& judgement, const Verdict& verdict) {
  if (verdict.verdict == "not_separable") {
    return rivals_of_set(judgement, verdict.not_separable.front());
  }
  if (verdict.verdict == "missing_physics") return probable_rivals(judgement);
  if (verdict.verdict == "unknown_physics") return rivals_of_unknown(judgement);
  return {};
}

/// Where nothing that can be simulated is worth making.
std::string in_vain(const PlannedExperiment& plan) {
  return "none of " + std::to_string(plan.looked_at) +
         " experiments within what the recordings show to be safe tells them apart (the best by " +
         format_significant(plan.sigmas, 2) + " sigma: " + plan.action + ")";
}

}  // namespace

void plan_next_experiment(const Fitter& fitter, const std::vector<DataSet>& sets,
                          const Judgement& judgement, int threads, Verdict& verdict) {
  verdict.next_experiment = words_of_catalogue(judgement, verdict);
  std::vector<Rival> rivals = rivals_of(judgement, verdict);
  if (rivals.size() > kMostRivals) rivals.resize(kMostRivals);
  auto plan = design_experiment(fitter, sets, rivals, threads);
  if (!plan) return;
  if (plan->log10_odds < kWorthMaking) {
    const std::string& words = verdict.next_experiment;
    verdict.next_experiment = (words.empty() ? "" : words + "; ") + in_vain(*plan);
    return;
  }
  verdict.next_experiment = experiment_sentence(*plan);
  verdict.planned_experiment = std::move(plan);
}

}  // namespace hoof::tools
