#include "tools/diagnose/diagnose.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/evidence_text.h"
#include "tools/diagnose/foot_effects.h"
#include "tools/diagnose/judge.h"
#include "tools/diagnose/next_experiment.h"
#include "tools/diagnose/quality.h"
#include "tools/diagnose/rollout_errors.h"
#include "tools/diagnose/where.h"

namespace hoof::tools {
namespace {

/// Rivals in the table of ablation.
constexpr int kRivals = 6;
/// Hypotheses are told apart where one is this probable among those that name physics.
constexpr double kNamed = 0.5;
/// Members of a set that cannot be told apart.
constexpr double kInSet = 0.12;

/// Half of a 95 % interval in standard deviations of the fit. Twice the normal's: a model's own
/// errors, which look like no noise, are as large again (README, concealed plants).
constexpr double kWide = 4.0;

class Diagnosis {
 public:
  Diagnosis(const std::vector<DataSet>& sets, const RigModel& model, const DiagnoseOptions& options)
      : sets_(sets), model_(model), options_(options), fitter_(model) {}

  Verdict run() {
    SearchOptions search_options = model_.costly() ? frugal_search() : SearchOptions();
    search_options.threads = options_.threads;
    search_options.progress = options_.progress;
    if (model_.quick()) {
      // All starts are followed, and long valleys (k_phi against n) to their end.
      search_options.iterations = 60;
      search_options.fits_of_single = 8;
    }
    result_ = search(fitter_, search_options);
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

  void decide();
  /// Square of the marginal: a member that is in every likely hypothesis gets nearly all.
  double sure(const sim::EffectInfo* effect) const {
    const double marginal = judgement_.marginals.at(std::string(effect->name));
    return marginal * marginal;
  }
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

void Diagnosis::decide() {
  // What is written sums to one: a pair's probability is shared out by how sure each member is.
  auto& p = verdict_.probabilities;
  p["none"] = judgement_.none;
  p["unknown"] = judgement_.unknown;
  for (const auto& [name, marginal] : judgement_.marginals) p[name] = 0;
  for (const Standing& s : judgement_.standings) {
    if (s.fit->effects.empty() || !s.listed) continue;
    double sum = 0;
    for (const auto* e : s.fit->effects) sum += sure(e);
    for (const auto* e : s.fit->effects) {
      p[std::string(e->name)] += s.probability * (sum > 0 ? sure(e) / sum : 0);
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
  winner_ = best->fit;
  verdict_.verdict = "missing_physics";
  // Those that stand beside the best without being more than it with something added.
  std::vector<std::string> set;
  if (best->probability < kNamed * missing) {
    for (const Standing& s : judgement_.standings) {
      if (s.fit->effects.empty() || !s.listed || s.probability < kInSet * missing) continue;
      for (const sim::EffectInfo* e : s.fit->effects) {
        const std::string name(e->name);
        if (std::find(set.begin(), set.end(), name) == set.end()) set.push_back(name);
      }
    }
  }
  if (set.size() > 1) {
    verdict_.verdict = "not_separable";
    verdict_.not_separable.push_back(set);
  }
}

EffectFinding Diagnosis::finding(const sim::EffectInfo* effect) const {
  EffectFinding finding;
  finding.name = effect->name;
  const auto marginal = judgement_.marginals.find(finding.name);
  finding.probability = marginal == judgement_.marginals.end() ? 0 : marginal->second;
  // Its parameters in the most probable hypothesis that holds it.
  for (const Standing& s : judgement_.standings) {
    const auto& effects = s.fit->effects;
    const auto at = std::find(effects.begin(), effects.end(), effect);
    if (at == effects.end()) continue;
    const Layout layout(model_, effects);
    int i = 0;
    for (auto e = effects.begin(); e != at; ++e) i += static_cast<int>((*e)->parameters.size());
    for (std::size_t k = 0; k < effect->parameters.size(); ++k, ++i) {
      const int c = layout.setup_count() + i;
      const double x = s.fit->x[c];
      const double wide = kWide * std::sqrt(std::max(s.fit->covariance(c, c), 0.0));
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
                              after.setup_value(i, winner_->x[i])});
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
