#include "tools/diagnose/judge.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

/// Shares of what is met, by the contract's section 5; the undecidable ones are effects too.
constexpr double kNone = 0.30, kSingle = 0.38, kPair = 0.17, kUnknown = 0.15;
/// Evidence is counted down by this: samples that look independent share one model's errors, and
/// a fitted integrator is not the plant. From the calibration on concealed plants (README).
constexpr double kTemperature = 3.0;
/// Unknown physics is suspected where the best of the list explains less than this share.
constexpr double kExplainedByKnown = 0.85;
constexpr double kExplainedSpread = 0.05;

bool listed(const Fit& fit) {
  return std::all_of(fit.effects.begin(), fit.effects.end(),
                     [](const sim::EffectInfo* e) { return e->listed; });
}

double holdout_gain(const Fitter& fitter, const Fit& fit, const Fit& none) {
  double gain = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (!group.holdout) continue;
    gain -=
        0.5 * group.effective * (fit.squares[g] - none.squares[g]) / (group.sigma * group.sigma);
  }
  return gain;
}

/// Sum over groups of the logarithm of how much smaller the variance became; and how much it could.
struct Gains {
  double made = 0, possible = 0, samples = 0;
};

Gains gains(const Fitter& fitter, const Fit& fit, const Fit& none) {
  Gains sum;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (group.samples < 1) continue;
    const double floor = group.noise * group.noise;
    const double before = std::max(none.squares[g] / group.samples, floor);
    const double after = std::max(fit.squares[g] / group.samples, floor);
    sum.made += 0.5 * group.samples * std::log(before / after);
    sum.possible += 0.5 * group.samples * std::log(before / floor);
    sum.samples += group.samples;
  }
  return sum;
}

double log_prior(const Fit& fit, double singles, double pairs, double stand_ins) {
  if (fit.effects.empty()) return std::log(kNone);
  if (!listed(fit)) return std::log(kUnknown / std::max(stand_ins, 1.0));
  return fit.effects.size() == 1 ? std::log(kSingle / singles) : std::log(kPair / pairs);
}

}  // namespace

Judgement judge(const Fitter& fitter, const SearchResult& result) {
  const Fit& none = result.fits[0];
  double singles = 0, stand_ins = 0;
  for (const sim::EffectInfo* effect : fitter.model().effects()) {
    (effect->listed ? singles : stand_ins) += 1;
  }
  const double pairs = std::max(1.0, singles * (singles - 1) / 2);
  Judgement j;
  double top = -1e300;
  std::vector<double> score;
  for (const Fit& fit : result.fits) {
    Standing s{
        &fit, listed(fit), fit.log_evidence - none.log_evidence, holdout_gain(fitter, fit, none), 0,
        0};
    const Gains g = gains(fitter, fit, none);
    s.explained = g.possible > 0 ? g.made / g.possible : 1;
    score.push_back((s.evidence + s.holdout_gain) / kTemperature +
                    log_prior(fit, singles, pairs, stand_ins));
    top = std::max(top, score.back());
    j.standings.push_back(s);
  }
  double sum = 0;
  for (std::size_t i = 0; i < score.size(); ++i) {
    sum += j.standings[i].probability = std::exp(score[i] - top);
  }
  for (Standing& s : j.standings) s.probability /= sum;
  std::stable_sort(
      j.standings.begin(), j.standings.end(),
      [](const Standing& a, const Standing& b) { return a.probability > b.probability; });
  const Gains all = gains(fitter, none, none);
  j.misfit = all.samples > 0 ? all.possible / all.samples : 0;
  for (const Standing& s : j.standings) {
    if (s.listed) {
      j.best_explained = s.explained;
      break;
    }
  }
  for (const sim::EffectInfo* effect : fitter.model().effects()) {
    if (effect->listed) j.marginals[std::string(effect->name)] = 0;
  }
  for (const Standing& s : j.standings) {
    if (s.fit->effects.empty()) {
      j.none += s.probability;
    } else if (!s.listed) {
      j.unknown += s.probability;
    } else {
      for (const sim::EffectInfo* e : s.fit->effects) {
        j.marginals[std::string(e->name)] += s.probability;
      }
    }
  }
  return j;
}

}  // namespace hoof::tools
