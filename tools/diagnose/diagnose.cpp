#include "tools/diagnose/diagnose.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/costly_search.h"
#include "tools/diagnose/evidence_text.h"
#include "tools/diagnose/foot_effects.h"
#include "tools/diagnose/judge.h"
#include "tools/diagnose/next_experiment.h"
#include "tools/diagnose/quality.h"
#include "tools/diagnose/rollout_errors.h"
#include "tools/diagnose/search_start.h"
#include "tools/diagnose/where.h"

namespace hoof::tools {
namespace {

/// Rivals in the table of ablation.
constexpr int kRivals = 6;
/// Log likelihood by which a rival may fit worse, no simpler for that, and not be told apart: as a
/// chi-square of one number tells at 99 %.
constexpr double kAlike = 3.5;
/// And no less probable than this share of the best, all told.
constexpr double kLeastInSet = 1e-4;
/// Of a pair's probability, the share of the member that matters more.
constexpr double kLeader = 0.85;

/// Half of a 95 % interval: this many standard deviations of the fit and, whatever those say, a
/// share of the number itself (or radians). A model's own errors look like no noise and are larger
/// than what it makes of the noise (concealed plants of hoof conceal, seed 811).
constexpr double kWide = 5.0, kLeastWide = 0.03;

class Diagnosis {
 public:
  Diagnosis(const std::vector<DataSet>& sets, const RigModel& model, const DiagnoseOptions& options)
      : sets_(sets), model_(model), options_(options), fitter_(model) {}

  Verdict run() {
    result_ = searched();
    judgement_ = judge(fitter_, result_);
    decide();
    name_effects();
    say_where();
    measure();
    describe();
    return std::move(verdict_);
  }

 private:
  const Fit& none() const { return result_.fits[0]; }

  /// The most probable that names something, or null.
  const Standing* best_listed() const {
    for (const Standing& s : judgement_.standings) {
      if (!s.fit->effects.empty() && s.listed) return &s;
    }
    return nullptr;
  }

  SearchResult searched();
  void decide();
  /// Of a pair the member that matters more: the more probable of all, then the better alone.
  const sim::EffectInfo* leader(const Fit& fit) const;
  /// A rival that leaves hardly more than the best and is not the best with something added.
  bool alike(const Standing& rival, const Standing& best) const;
  double said_against(const Fit& fit) const;
  bool hardly_worse(const Standing& rival, const Standing& best) const;
  void name_effects();
  void say_where();
  void measure();
  void describe();
  EffectFinding finding(const sim::EffectInfo* effect) const;

  const std::vector<DataSet>& sets_;
  const RigModel& model_;
  const DiagnoseOptions& options_;
  Fitter fitter_;
  SearchResult result_;
  Judgement judgement_;
  Verdict verdict_;
  const Fit* winner_ = nullptr;
};

SearchResult Diagnosis::searched() {
  if (model_.costly()) {
    CostlyOptions costly;
    costly.threads = options_.threads;
    costly.progress = options_.progress;
    return costly_search(fitter_, costly);
  }
  SearchOptions search_options;
  search_options.threads = options_.threads;
  search_options.progress = options_.progress;
  if (model_.quick()) {
    // All starts are followed, and long valleys (k_phi against n) to their end.
    search_options.iterations = 60;
    search_options.fits_of_single = 8;
    search_options.rough_iterations = 0;
  }
  return search(fitter_, search_options);
}

void Diagnosis::decide() {
  // What is written sums to one: of a pair's probability most goes to the member that leads.
  auto& p = verdict_.probabilities;
  p["none"] = judgement_.none;
  p["unknown"] = judgement_.unknown;
  for (const auto& [name, marginal] : judgement_.marginals) p[name] = 0;
  for (const Standing& s : judgement_.standings) {
    if (s.fit->effects.empty() || !s.listed) continue;
    const double rest = s.fit->effects.size() > 1
                            ? (1 - kLeader) / static_cast<double>(s.fit->effects.size() - 1)
                            : 0;
    const sim::EffectInfo* first = leader(*s.fit);
    for (const auto* e : s.fit->effects) {
      const double share = s.fit->effects.size() == 1 ? 1 : e == first ? kLeader : rest;
      p[std::string(e->name)] += share * s.probability;
    }
  }

  winner_ = &none();
  const double missing = 1 - judgement_.none - judgement_.unknown;
  if (judgement_.none >= judgement_.unknown && judgement_.none >= missing) {
    verdict_.verdict = "none";
    return;
  }
  if (judgement_.unknown > missing) {
    verdict_.verdict = "unknown_physics";
    for (const Standing& s : judgement_.standings) {
      if (!s.listed) {
        winner_ = s.fit;
        break;
      }
    }
    return;
  }
  const Standing* best = best_listed();
  // What does as well without one of its effects does not need it.
  for (const Standing& s : judgement_.standings) {
    const bool simpler = !s.fit->effects.empty() && s.listed &&
                         s.fit->effects.size() < best->fit->effects.size() &&
                         part_of(s.fit->effects, best->fit->effects);
    if (simpler && hardly_worse(s, *best)) {
      best = &s;
      break;
    }
  }
  winner_ = best->fit;
  verdict_.verdict = "missing_physics";
  std::vector<std::string> set;
  const auto add = [&set](const Standing& s) {
    for (const sim::EffectInfo* e : s.fit->effects) {
      const std::string name(e->name);
      if (std::find(set.begin(), set.end(), name) == set.end()) set.push_back(name);
    }
  };
  add(*best);
  const std::size_t own = set.size();
  for (const Standing& s : judgement_.standings) {
    if (alike(s, *best)) add(s);
  }
  if (set.size() > own) {
    verdict_.verdict = "not_separable";
    verdict_.not_separable.push_back(set);
  }
}

const sim::EffectInfo* Diagnosis::leader(const Fit& fit) const {
  const auto alone = [this](const sim::EffectInfo* effect) {
    for (const Standing& s : judgement_.standings) {
      if (s.fit->effects.size() == 1 && s.fit->effects[0] == effect) return s.evidence;
    }
    return -1e300;
  };
  const sim::EffectInfo* first = fit.effects[0];
  for (const sim::EffectInfo* e : fit.effects) {
    const double a = judgement_.marginals.at(std::string(e->name));
    const double b = judgement_.marginals.at(std::string(first->name));
    const bool tie = std::abs(a - b) < 1e-9;
    if (a > b + 1e-9 || (tie && alone(e) > alone(first))) first = e;
  }
  return first;
}

/// What the recordings, and what is known of the setup, say against a fit: its objective less what
/// is thought of the effects' own numbers beforehand.
double Diagnosis::said_against(const Fit& fit) const {
  const Layout layout(model_, fit.effects);
  double sum = fit.objective;
  for (int i = layout.setup_count(); i < layout.size(); ++i) {
    sum -= 0.5 * std::pow((fit.x[i] - layout.prior_mean(i)) / layout.prior_sigma(i), 2);
  }
  return sum;
}

bool Diagnosis::hardly_worse(const Standing& rival, const Standing& best) const {
  const double worse = said_against(*rival.fit) - said_against(*best.fit);
  return worse + std::max(best.holdout_gain - rival.holdout_gain, 0.0) < kAlike;
}

bool Diagnosis::alike(const Standing& rival, const Standing& best) const {
  const Effects& effects = rival.fit->effects;
  if (effects.empty() || !rival.listed || effects.size() > best.fit->effects.size() ||
      part_of(best.fit->effects, effects) || rival.probability < kLeastInSet * best.probability) {
    return false;
  }
  return hardly_worse(rival, best);
}

EffectFinding Diagnosis::finding(const sim::EffectInfo* effect) const {
  EffectFinding finding;
  finding.name = effect->name;
  const auto marginal = judgement_.marginals.find(finding.name);
  finding.probability = marginal == judgement_.marginals.end() ? 0 : marginal->second;
  // Its parameters in what is named, else in the most probable hypothesis that holds it.
  std::vector<const Fit*> fits = {winner_};
  for (const Standing& s : judgement_.standings) fits.push_back(s.fit);
  for (const Fit* fit : fits) {
    const auto& effects = fit->effects;
    const auto at = std::find(effects.begin(), effects.end(), effect);
    if (at == effects.end()) continue;
    const Layout layout(model_, effects);
    int i = 0;
    for (auto e = effects.begin(); e != at; ++e) i += static_cast<int>((*e)->parameters.size());
    for (std::size_t k = 0; k < effect->parameters.size(); ++k, ++i) {
      const int c = layout.setup_count() + i;
      const double x = fit->x[c];
      const double deviation = std::sqrt(std::max(fit->covariance(c, c), 0.0));
      const double wide = std::hypot(kWide * deviation, kLeastWide);
      ParameterEstimate estimate{std::string(effect->parameters[k].name), layout.effect_value(i, x),
                                 std::string(effect->parameters[k].unit),
                                 layout.effect_value(i, x - wide),
                                 layout.effect_value(i, x + wide)};
      if (effect->parameters[k].cyclic) {
        estimate.low95 = estimate.value - wide;
        estimate.high95 = estimate.value + wide;
      }
      finding.parameters.push_back(estimate);
    }
    for (const RigModel::Counted& c : model_.counted(*effect)) {
      ParameterEstimate& estimate = finding.parameters[static_cast<std::size_t>(c.parameter)];
      estimate.value = c.value, estimate.low95 = c.low95, estimate.high95 = c.high95;
    }
    break;
  }
  return finding;
}

void Diagnosis::name_effects() {
  for (const sim::EffectInfo* effect : model_.effects()) {
    if (effect->listed) verdict_.effects.push_back(finding(effect));
  }
  std::stable_sort(
      verdict_.effects.begin(), verdict_.effects.end(),
      [](const EffectFinding& a, const EffectFinding& b) { return a.probability > b.probability; });
  for (const sim::EffectInfo* effect : winner_->effects) {
    if (effect->listed) verdict_.named.push_back(std::string(effect->name));
  }
  const Layout before(model_, {}), after(model_, winner_->effects);
  for (int i = 0; i < before.setup_count(); ++i) {
    const DoubtfulValue& doubt = model_.doubtful()[i];
    verdict_.setup.push_back({doubt.name, doubt.value, doubt.sigma,
                              before.setup_value(i, none().x[i]),
                              after.setup_value(i, winner_->x[i]), !doubt.stated});
  }
  for (const Standing& s : judgement_.standings) {
    double samples = 0;
    for (const Group& group : fitter_.groups()) samples += group.holdout ? 0 : group.samples;
    const std::string name = name_of(s.fit->effects);
    verdict_.hypotheses.push_back({s.listed ? name : "(" + name + ")",
                                   static_cast<int>(s.fit->x.size()),
                                   plain_log_likelihood(fitter_, *s.fit), samples, s.evidence,
                                   s.holdout_gain, s.probability});
  }
}

void Diagnosis::say_where() {
  if (winner_->effects.empty()) return;
  Fit without = *winner_;
  without.effects.clear();
  without.x = winner_->x.head(Layout(model_, {}).setup_count());
  const Place place = place_of(fitter_, *winner_, without);
  verdict_.channels = place.channels;
  verdict_.recordings = place.recordings;
  verdict_.intervals = place.intervals;
  verdict_.condition = place.condition;
}

void Diagnosis::measure() {
  const Rollouts before = roll_out(fitter_, none(), options_.threads);
  const Rollouts after = roll_out(fitter_, *winner_, options_.threads);
  verdict_.before = before.errors;
  verdict_.after = after.errors;
  verdict_.noise_floor = noise_floor(fitter_);
  for (int i = 0; i < model_.recordings(); ++i) {
    const Recording& recording = model_.recording(i);
    for (std::size_t c = 0; c < model_.channels(i).size(); ++c) {
      const std::string& name = model_.channels(i)[c];
      verdict_.traces.push_back({recording.name, name, recording.holdout, recording.time_s,
                                 recording.channels.at(name), before.predictions[i][c],
                                 after.predictions[i][c]});
    }
  }
  const auto add = [this](const std::string& name, const RoleErrors& errors) {
    verdict_.ablation.push_back({name, errors.fit, errors.holdout});
  };
  add("nominal", verdict_.before);
  std::vector<const Fit*> rows;
  if (!winner_->effects.empty()) rows.push_back(winner_);
  for (const Standing& s : judgement_.standings) {
    if (static_cast<int>(rows.size()) >= kRivals) break;
    if (s.fit != winner_ && s.fit->effects.size() == 1) rows.push_back(s.fit);
  }
  for (const Fit* fit : rows) {
    add("nominal + " + name_of(fit->effects),
        fit == winner_ ? verdict_.after : roll_out(fitter_, *fit, options_.threads).errors);
  }
  // The winner with each of its effects taken away again, nothing refitted.
  for (std::size_t k = 0; k < winner_->effects.size(); ++k) {
    const Fit fit = without_effect(model_, *winner_, k);
    add("nominal + " + name_of(winner_->effects) + ", " + std::string(winner_->effects[k]->name) +
            " taken away",
        roll_out(fitter_, fit, options_.threads).errors);
  }
  if (verdict_.verdict == "unknown_physics") {
    verdict_.unknown_term =
        describe_unknown(fitter_, none(), *winner_, verdict_.channels, verdict_.after.holdout);
  }
}

void Diagnosis::describe() {
  plan_next_experiment(fitter_, sets_, judgement_, options_.threads, verdict_);
  write_evidence(judgement_, fitter_, none(), *winner_, verdict_);
}

}  // namespace

Verdict diagnose(const std::vector<DataSet>& data_sets, const DiagnoseOptions& options) {
  const auto model = make_rig_model(data_sets);
  try {
    Verdict verdict = Diagnosis(data_sets, *model, options).run();
    name_joints(verdict);
    for (const DataSet& data_set : data_sets) {
      if (data_set.rig == RigKind::kFootHil) continue;  // by our own recorder
      for (QualityNote& note : check_quality(data_set)) verdict.quality.push_back(std::move(note));
    }
    for (QualityNote& note : model->notes()) verdict.quality.push_back(std::move(note));
    return verdict;
  } catch (const SearchStopped&) {
    return {};
  }
}

}  // namespace hoof::tools
