#include "tools/diagnose/judge.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/search_start.h"

namespace hoof::tools {
namespace {

/// Shares of what is met, by the contract's section 5; the undecidable ones are effects too.
constexpr double kNone = 0.30, kSingle = 0.38, kPair = 0.17, kUnknown = 0.15;
/// And the more so the more there is to explain: a model's own errors grow with the effect. A
/// thousandth of the best's evidence is worth ten at most in a logarithm of odds.
constexpr double kRelative = 1.0 / 10000;
constexpr double kLeastGain = 2, kNoFinding = 4;
/// Of the order in what the nominal model leaves (structure()), what of the list leaves this share
/// is as likely as not to miss something that is not in the list; e times as likely for each
/// spread.
constexpr double kLeftByKnown = 0.45, kLeftSpread = 0.05;
/// What explains little but foretells recordings that it was not fitted to is no chance: e times
/// less likely to miss the point for each so much of their log likelihood.
constexpr double kHeldOutProof = 5;
/// The same of the logarithm by which their error falls, in the mean over channels and recordings,
/// however few of their samples are independent. By chance it falls by less than the first of
/// these.
constexpr double kForetold = 0.1, kForetoldSpread = 0.04;
/// A nominal model that leaves so much, and nothing that takes it away: the same.
constexpr double kUnexplained = 0.2, kUnexplainedSpread = 0.03;
/// Where it leaves less, shares of it say nothing.
constexpr double kLeastStructure = 0.004;
/// Share of answers that are wrong although the evidence is overwhelming, on concealed plants.
constexpr double kDoubt = 0.07;

/// Held-out recordings that a hypothesis explains worse than nothing does, by more than this in log
/// likelihood: what it explains in the others is something else. So it was of one in 266 fits of
/// what concealed plants truly had.
constexpr double kContradicted = 6;

/// A held-out channel of one recording decides no more than this, in log likelihood.
constexpr double kMostOfOneGroup = 15;

/// Held-out recordings, each channel by the logarithm of what is left above the noise as the best
/// model leaves it: a rollout that went another way says that much, and no more.
double holdout_gain(const Fitter& fitter, const Fit& fit, const Fit& none) {
  double sum = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (!group.holdout || group.samples < 1) continue;
    const double least = group.sigma * group.sigma;
    const double before = std::max(none.squares[g] / group.samples, least);
    const double after = std::max(fit.squares[g] / group.samples, least);
    const double gain = 0.5 * group.effective * group.samples * std::log(before / after);
    sum += std::clamp(gain, -kMostOfOneGroup, kMostOfOneGroup);
  }
  return sum;
}

/// Mean over held-out recordings and channels of the logarithm by which their error is smaller.
double foretold(const Fitter& fitter, const Fit& fit, const Fit& none) {
  double sum = 0, count = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (!group.holdout || group.samples < 1) continue;
    const double floor = group.floor * group.floor;
    const double before = std::max(none.squares[g] / group.samples, floor);
    const double after = std::max(fit.squares[g] / group.samples, floor);
    sum += 0.5 * std::log(before / after);
    count += 1;
  }
  return count > 0 ? sum / count : 0;
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
    const double floor = group.floor * group.floor;
    const double before = std::max(none.squares[g] / group.samples, floor);
    const double after = std::max(fit.squares[g] / group.samples, floor);
    sum.made += 0.5 * group.samples * std::log(before / after);
    sum.possible += 0.5 * group.samples * std::log(before / floor);
    sum.samples += group.samples;
  }
  return sum;
}

/// Evidence as it enters a probability: what fits better than the nominal model by more than the
/// tolerance is counted down, less what was taken from the recordings themselves; what fits worse
/// and what parameters cost count in full. An effect that changes nothing is no finding, nor is one
/// that held-out recordings speak against.
double tempered(const Standing& s, const Fitter& fitter, const Fit& none, double tolerance,
                double most) {
  if (s.fit->effects.empty()) return 0;
  double taken = 0;
  for (const sim::EffectInfo* effect : s.fit->effects) taken += fitter.model().complexity(*effect);
  const double closer = none.objective - s.fit->objective;
  const double cost = s.evidence - closer + taken;
  // Chance in what is held out is no more than what it goes with.
  const double fits = closer - taken;
  const double gain = fits + std::min(s.holdout_gain, std::max(fits, 0.0));
  double counted =
      gain > 0 ? std::max(gain - tolerance, 0.0) / (kTemperature + kRelative * most) : gain;
  if (s.holdout_gain < -kContradicted) counted = std::min(counted, 0.0) + s.holdout_gain;
  const bool nothing = s.fit->log_likelihood - none.log_likelihood < kLeastGain;
  return std::min(cost, 0.0) + (nothing ? std::min(counted, 0.0) - kNoFinding : counted);
}

/// A pair that predicts held-out recordings worse than one of its members alone has fitted the rest
/// too well: half of what it loses, in log likelihood.
double worse_held_out(const Fitter& fitter, const SearchResult& result, const Fit& pair) {
  if (pair.effects.size() < 2) return 0;
  const Fit& none = result.fits[0];
  double best = -1e300;
  for (const Fit& fit : result.fits) {
    const bool member =
        fit.effects.size() == 1 &&
        std::find(pair.effects.begin(), pair.effects.end(), fit.effects[0]) != pair.effects.end();
    if (member) best = std::max(best, holdout_gain(fitter, fit, none));
  }
  return 0.5 * std::max(best - holdout_gain(fitter, pair, none), 0.0);
}

/// What a fit leaves above the noise and in order, as log likelihood per sample: what looks
/// independent from sample to sample is noise, wherever it is from.
double structure(const Fitter& fitter, const Fit& fit) {
  double sum = 0, samples = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (group.holdout || group.samples < 1) continue;
    const double noise = group.floor * group.floor;
    const double above = std::max(fit.squares[g] / (group.samples * noise) - 1, 0.0);
    sum += 0.5 * group.samples * std::log1p((1 - group.effective) * above);
    samples += group.samples;
  }
  return samples > 0 ? sum / samples : 0;
}

double log_prior(const Fit& fit, double singles, double pairs, double stand_ins) {
  if (fit.effects.empty()) return std::log(kNone);
  if (!listed(fit.effects)) return std::log(kUnknown / std::max(stand_ins, 1.0));
  return fit.effects.size() == 1 ? std::log(kSingle / singles) : std::log(kPair / pairs);
}

/// Takes from each hypothesis what it leaves unexplained, for the unknown.
void suspect_unknown(std::vector<Standing>& standings, double none) {
  for (Standing& s : standings) {
    if (s.fit->effects.empty()) {
      s.insufficient = 1 / (1 + std::exp((kUnexplained - none) / kUnexplainedSpread));
    } else if (s.listed && none > kLeastStructure) {
      const double proof = std::max(
          {s.holdout_gain / kHeldOutProof, (s.foretold - kForetold) / kForetoldSpread, 0.0});
      s.insufficient = 1 / (1 + std::exp((kLeftByKnown - s.left) / kLeftSpread + proof));
    }
  }
}

/// The search may have missed the truth, and the list may not hold it: no finding is surer than
/// this leaves it.
void keep_doubt(Judgement& j) {
  for (Standing& s : j.standings) s.probability *= 1 - kDoubt;
  for (auto& [name, marginal] : j.marginals) marginal *= 1 - kDoubt;
  j.none = (1 - kDoubt) * j.none + 0.4 * kDoubt;
  j.unknown = (1 - kDoubt) * j.unknown + 0.6 * kDoubt;
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
  double tolerance = 0;
  for (const Group& group : fitter.groups()) {
    if (!group.holdout) tolerance += kTolerated * group.effective * group.samples;
  }
  double most = 0;
  for (const Fit& fit : result.fits) {
    most = std::max(most, fit.log_evidence - none.log_evidence + holdout_gain(fitter, fit, none));
  }
  const double whole = structure(fitter, none);
  double top = -1e300;
  std::vector<double> score;
  for (const Fit& fit : result.fits) {
    Standing s{.fit = &fit,
               .listed = listed(fit.effects),
               .evidence = fit.log_evidence - none.log_evidence,
               .holdout_gain = holdout_gain(fitter, fit, none)};
    const Gains g = gains(fitter, fit, none);
    s.explained = g.possible > 0 ? g.made / g.possible : 1;
    s.foretold = foretold(fitter, fit, none);
    s.left = whole > 0 ? structure(fitter, fit) / whole : 0;
    score.push_back(tempered(s, fitter, none, tolerance, most) -
                    worse_held_out(fitter, result, fit) +
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
  suspect_unknown(j.standings, whole);
  const Gains all = gains(fitter, none, none);
  j.misfit = all.samples > 0 ? all.possible / all.samples : 0;
  for (const sim::EffectInfo* effect : fitter.model().effects()) {
    if (effect->listed) j.marginals[std::string(effect->name)] = 0;
  }
  for (Standing& s : j.standings) {
    if (s.fit->effects.empty()) {
      j.unknown += s.insufficient * s.probability;
      s.probability *= 1 - s.insufficient;
      j.none += s.probability;
    } else if (!s.listed) {
      j.unknown += s.probability;
    } else {
      j.unknown += s.insufficient * s.probability;
      s.probability *= 1 - s.insufficient;
      for (const sim::EffectInfo* e : s.fit->effects) {
        j.marginals[std::string(e->name)] += s.probability;
      }
    }
  }
  keep_doubt(j);
  return j;
}

}  // namespace hoof::tools
