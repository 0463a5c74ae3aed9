#include "tools/diagnose/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/judge.h"
#include "tools/diagnose/rig_keys.h"
#include "tools/diagnose/rival_predictor.h"
#include "tools/diagnose/telling_reading.h"

namespace hoof::tools {
namespace {

/// Decades of odds beyond which more is worth little: room for what models do not know.
constexpr double kDecisive = 8, kBeyond = 0.5;
/// Widths are of linearised predictions: no more than this much of them counts, in squares.
constexpr double kMostOfWidths = 18;
constexpr double kDecadesPerSecond = 0.01;  // what an experiment's time costs
/// Candidates that are looked at closely at once; a constant, so that threads change nothing.
constexpr int kBatch = 8;

double decades(double squares) {
  return squares / (2 * kTemperature * std::numbers::ln10);
}

double worth_of(double squares) {
  const double odds = decades(squares);
  return odds <= kDecisive ? odds : kDecisive + kBeyond * std::log10(odds / kDecisive);
}

/// Driven by a torque: what is compared is a rollout that is drawn to what will be measured.
bool is_open_loop(const DataSet& set) {
  return set.recordings.front().setup.law == DriveLaw::kTorque;
}

class Design {
 public:
  Design(const Fitter& fitter, const std::vector<DataSet>& sets, std::vector<Candidate> candidates,
         const std::vector<Rival>& rivals, int threads)
      : fitter_(fitter),
        candidates_(std::move(candidates)),
        rivals_(rivals),
        threads_(threads),
        predictor_(fitter, sets, candidates_, rivals) {
    for (int i = 0; i < predictor_.rivals(); ++i) {
      for (int j = i + 1; j < predictor_.rivals(); ++j) {
        pairs_.push_back({i, j, rivals[i].probability * rivals[j].probability});
      }
    }
    double sum = 0;
    for (const Pair& pair : pairs_) sum += pair.weight;
    for (Pair& pair : pairs_)
      pair.weight = sum > 0 ? pair.weight / sum : 1.0 / double(pairs_.size());
  }

  std::optional<PlannedExperiment> run();

 private:
  struct Pair {
    int a = 0, b = 0;
    double weight = 0;
  };
  /// Of a pair: how far apart, and what half of it are the expected odds. Squares.
  struct Apart {
    double separation = 0, evidence = 0;
  };
  struct Look {
    bool safe = false;
    std::vector<Apart> apart;  // by pair; of a first look: no more than these are possible
    double worth = -1e300;
  };

  static bool less_evident(const Apart& a, const Apart& b) { return a.evidence < b.evidence; }
  int recording_of(int candidate) const { return predictor_.recordings_made() + candidate; }
  double tolerated(int recording) const {
    return 2 * kTolerated * predictor_.independent(recording);
  }
  double worth(const Candidate& candidate, const std::vector<Apart>& apart) const;
  bool is_safe(const Candidate& candidate, int recording,
               const std::vector<Prediction>& predictions) const;
  Look first_look(int candidate) const;
  std::vector<Apart> separations(int recording) const;
  double best_again() const;
  PlannedExperiment plan(int candidate, const std::vector<Apart>& apart, int looked_at) const;
  void describe_outcomes(int recording, const Pair& weakest, PlannedExperiment& plan) const;

  const Fitter& fitter_;
  std::vector<Candidate> candidates_;
  const std::vector<Rival>& rivals_;
  int threads_;
  RivalPredictor predictor_;
  std::vector<Pair> pairs_;
};

double Design::worth(const Candidate& candidate, const std::vector<Apart>& apart) const {
  double sum = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    sum += pairs_[i].weight * worth_of(apart[i].evidence);
  }
  const auto& time_s = candidate.set.recordings.front().time_s;
  return sum - candidate.effort - kDecadesPerSecond * (time_s.back() - time_s.front());
}

/// What any hypothesis expects to leave the bounds is not tried on a machine.
bool Design::is_safe(const Candidate& candidate, int recording,
                     const std::vector<Prediction>& predictions) const {
  const auto& names = predictor_.model().channels(recording);
  for (const Prediction& p : predictions) {
    for (std::size_t c = 0; c < p.size(); ++c) {
      const auto bounds = candidate.safe.find(names[c]);
      for (std::size_t i = 0; i < p[c].size(); ++i) {
        const double v = p[c][i];
        if (std::isinf(v) || std::isnan(v) != std::isnan(predictions[0][c][i])) return false;
        if (bounds == candidate.safe.end()) continue;
        if (v < bounds->second.low || v > bounds->second.high) return false;
      }
    }
  }
  return true;
}

Design::Look Design::first_look(int candidate) const {
  const int recording = recording_of(candidate);
  std::vector<Prediction> predictions;
  std::vector<Eigen::VectorXd> y;
  for (int i = 0; i < predictor_.rivals(); ++i) {
    predictions.push_back(predictor_.predict(i, recording));
    y.push_back(predictor_.whitened(recording, predictions.back()));
    if (is_open_loop(candidates_[candidate].set)) {
      predictions.back() = predictor_.predict_free(i, recording);
    }
  }
  Look look;
  look.safe = is_safe(candidates_[candidate], recording, predictions);
  // What numbers are allowed to move only brings predictions nearer.
  for (const Pair& pair : pairs_) {
    const double squares = (y[pair.a] - y[pair.b]).squaredNorm() - tolerated(recording);
    look.apart.push_back({squares, std::max(squares, 0.0) + kMostOfWidths});
  }
  if (look.safe) look.worth = worth(candidates_[candidate], look.apart);
  return look;
}

/// By pair, with all numbers free to move as far as the recordings allow.
std::vector<Design::Apart> Design::separations(int recording) const {
  std::vector<WhitePrediction> white;
  for (int i = 0; i < predictor_.rivals(); ++i) white.push_back(predictor_.sloped(i, recording));
  std::vector<Apart> apart;
  for (const Pair& pair : pairs_) {
    const auto moved = [&](int rival) {
      return [this, rival, recording](const Eigen::VectorXd& u) {
        return predictor_.whitened(recording, predictor_.predict(rival, recording, u));
      };
    };
    const WhitePrediction &a = white[pair.a], &b = white[pair.b];
    const double least =
        std::min(separation_squares(a, b), closest_approach(a, b, moved(pair.a), moved(pair.b)));
    const double squares = std::max(least - tolerated(recording), 0.0);
    apart.push_back({squares, squares + std::min(width_squares(a, b), kMostOfWidths)});
  }
  return apart;
}

/// The square that the most telling of the recordings given would add if it were made once more, of
/// the pair that it tells apart worst.
double Design::best_again() const {
  int best = -1;
  double most = -1;
  for (int r = 0; r < predictor_.recordings_made(); ++r) {
    if (predictor_.model().recording(r).holdout) continue;
    double sum = 0;
    std::vector<Eigen::VectorXd> y;
    for (int i = 0; i < predictor_.rivals(); ++i) {
      y.push_back(predictor_.whitened(r, predictor_.predict(i, r)));
    }
    for (const Pair& pair : pairs_) {
      sum += pair.weight * worth_of((y[pair.a] - y[pair.b]).squaredNorm());
    }
    if (sum > most) most = sum, best = r;
  }
  if (best < 0) return 0;
  const std::vector<Apart> apart = separations(best);
  return std::min_element(apart.begin(), apart.end(), less_evident)->separation;
}

/// Values, their spread, and what tells the pair apart that is told apart worst.
void Design::describe_outcomes(int recording, const Pair& weakest, PlannedExperiment& plan) const {
  const auto& names = predictor_.model().channels(recording);
  const auto& time_s = predictor_.model().recording(recording).time_s;
  const auto count = static_cast<Eigen::Index>(time_s.size());
  std::vector<WhitePrediction> white;
  for (int i = 0; i < predictor_.rivals(); ++i) {
    const Prediction p = predictor_.predict(i, recording);
    white.push_back(predictor_.sloped(i, recording));
    ExpectedOutcome outcome{name_of(rivals_[i].fit->effects), {}, {}};
    Eigen::Index at = 0;
    for (const int c : predictor_.weighed(recording)) {
      const ChannelNoise& noise = predictor_.noise().at(names[c]);
      outcome.predicted[names[c]] = p[c];
      std::vector<double>& spread = outcome.spread[names[c]];
      for (Eigen::Index k = 0; k < count; ++k, ++at) {
        spread.push_back(white.back().M.row(at).norm() * noise.unit());
      }
      plan.noise[names[c]] = noise.sigma;
    }
    plan.outcomes.push_back(std::move(outcome));
  }
  Eigen::Index first = 0;
  for (const int c : predictor_.weighed(recording)) {
    const double unit = predictor_.noise().at(names[c]).unit();
    std::vector<WhitePrediction> part;
    for (const WhitePrediction& w : white) {
      part.push_back({w.y.segment(first, count), w.M.middleRows(first, count)});
    }
    first += count;
    const Reading reading = most_telling(part[weakest.a], part[weakest.b]);
    if (!(reading.sigmas > plan.telling.sigmas)) continue;
    plan.telling = {names[c],       time_s[reading.late.first],  time_s[reading.late.last],
                    reading.change, time_s[reading.early.first], time_s[reading.early.last],
                    reading.sigmas};
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto [value, sigma] = read(reading, part[i]);
      plan.outcomes[i].reading = unit * value;
      plan.outcomes[i].reading_sigma = unit * sigma;
    }
  }
}

PlannedExperiment Design::plan(int candidate, const std::vector<Apart>& apart,
                               int looked_at) const {
  PlannedExperiment plan;
  plan.action = candidates_[candidate].action;
  plan.set = candidates_[candidate].set;
  plan.open_loop = is_open_loop(plan.set);
  plan.looked_at = looked_at;
  const auto least = std::min_element(apart.begin(), apart.end(), less_evident);
  plan.sigmas = std::sqrt(least->separation);
  plan.log10_odds = decades(least->evidence);
  plan.again_sigmas = std::sqrt(best_again());
  describe_outcomes(recording_of(candidate), pairs_[least - apart.begin()], plan);
  return plan;
}

std::optional<PlannedExperiment> Design::run() {
  const int count = static_cast<int>(candidates_.size());
  std::vector<Look> looks(candidates_.size());
  for_each_task(count, threads_, [&](int i) { looks[i] = first_look(i); });
  std::vector<int> order;
  for (int i = 0; i < count; ++i) {
    if (looks[i].safe) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return looks[a].worth > looks[b].worth; });
  const int safe = static_cast<int>(order.size());
  int best = -1;
  double most = -1e300;
  // No candidate is worth more than its first look promised.
  for (int from = 0; from < safe && looks[order[from]].worth > most; from += kBatch) {
    const int batch = std::min(kBatch, safe - from);
    for_each_task(batch, threads_, [&](int k) {
      Look& look = looks[order[from + k]];
      look.apart = separations(recording_of(order[from + k]));
      look.worth = worth(candidates_[order[from + k]], look.apart);
    });
    for (int k = 0; k < batch; ++k) {
      const int i = order[from + k];
      if (looks[i].worth > most) most = looks[i].worth, best = i;
    }
  }
  if (best < 0) return std::nullopt;
  return plan(best, looks[best].apart, safe);
}

FittedSetup fitted_setup(const Fitter& fitter, const Fit& fit) {
  const Layout layout(fitter.model(), fit.effects);
  FittedSetup fitted;
  for (int i = 0; i < layout.setup_count(); ++i) {
    fitted[fitter.model().doubtful()[i].name] = layout.setup_value(i, fit.x[i]);
  }
  return fitted;
}

/// Which channels of the planned recording are to be played, which recorded.
void sort_channels(PlannedExperiment& plan) {
  const Recording& r = plan.set.recordings.front();
  const auto played = [&](const std::string& name) {
    switch (plan.set.rig) {
      case RigKind::kPlateSand:
        return name == "position";
      case RigKind::kRigidPress:
        return name == "force";
      default:
        return name == "position_goal" || name == "velocity_goal" || name == "torque_ff" ||
               name == "enable" || (name == "torque" && r.setup.law == DriveLaw::kTorque);
    }
  };
  for (const std::string& name : rig_keys(plan.set.rig).channels) {
    if (!r.has(name)) continue;
    (played(name) ? plan.input_channels : plan.output_channels).push_back(name);
  }
}

}  // namespace

std::optional<PlannedExperiment> design_experiment(const Fitter& fitter,
                                                   const std::vector<DataSet>& sets,
                                                   const std::vector<Rival>& rivals, int threads) {
  if (rivals.size() < 2) return std::nullopt;
  std::vector<Candidate> candidates =
      experiment_candidates(sets, fitted_setup(fitter, *rivals[0].fit));
  if (candidates.empty()) return std::nullopt;
  auto plan = Design(fitter, sets, std::move(candidates), rivals, threads).run();
  if (plan) sort_channels(*plan);
  return plan;
}

}  // namespace hoof::tools
