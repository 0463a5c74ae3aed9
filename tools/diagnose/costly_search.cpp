#include "tools/diagnose/costly_search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tools/diagnose/damped_fit.h"
#include "tools/diagnose/linear_look.h"
#include "tools/diagnose/noise_left.h"
#include "tools/diagnose/search_start.h"
#include "tools/diagnose/threshold_scan.h"

namespace hoof::tools {
namespace {

/// A channel that is off by no more than this many times its noise tells nothing.
constexpr double kQuiet = 1.2;
/// Explained is what is left with this share of its rms, or within this many times the noise.
constexpr double kExplained = 0.04, kNearNoise = 3;
/// Room for misfits, as a share of what a fit leaves: first looks and rough fits, then closer.
constexpr double kRough = 0.3, kCloser = 0.1;
/// Starts of one effect that are fitted roughly, where they promise this share of its best.
constexpr int kStartsOfOne = 3;
constexpr double kNearBest = 0.25;
constexpr std::size_t kPolished = 2;
constexpr int kRoughIterations = 5, kCloserIterations = 5, kLastIterations = 5;

/// No coordinate is known better: events in a rollout move by whole ticks, and from one to the
/// next the squares are ragged, not a bowl. A quarter of a slope's step.
constexpr double kLeastSigma = 0.005;

class CostlySearch {
 public:
  CostlySearch(Fitter& fitter, const CostlyOptions& options) : fitter_(fitter), options_(options) {}

  SearchResult run() {
    fit_nominal();
    say(0.05, "a first look at each effect");
    looked_ = look();
    const LinearBase base(fitter_, Fit(result_.fits[0]), look_weights_);
    fit_roughly(base, promising(options_.rough), 0.2, 0.45, "one effect");
    follow(best(1, options_.followed), 0.45, 0.6, "one effect");
    if (!explained(ranked().front())) scan_thresholds();
    if (!explained(ranked().front())) fit_pairs();
    take_noise_left(fitter_, ranked().front());
    judge_all();
    say(1, "done");
    return std::move(result_);
  }

 private:
  void say(double share, const std::string& what) const {
    if (options_.progress && !options_.progress(share, what)) throw SearchStopped();
  }

  template <class Task>
  void for_all(std::size_t count, double from, double to, const std::string& what, Task task) {
    std::atomic<int> done{0};
    for_each_task(static_cast<int>(count), options_.threads, [&](int i) {
      task(static_cast<std::size_t>(i));
      const double share = ++done / static_cast<double>(count);
      if (std::this_thread::get_id() == caller_) say(from + (to - from) * share, what);
    });
  }

  void fit_nominal() {
    say(0, "nominal model");
    Fit nominal;
    nominal.x = Layout(fitter_.model(), {}).stated();
    wide_squares_ = fitter_.squares(nominal);
    for (const double share : {0.5, kRough}) {
      nominal = damped_fit(fitter_, nominal, kCloserIterations, room(nominal, share));
    }
    result_.fits = {settle(nominal)};
    fitter_.judge(result_.fits[0]);
    look_weights_ = fitter_.roomy_weights(nominal_squares(), kRough);
    for (std::size_t g = 0; g < wide_squares_.size(); ++g) {
      wide_squares_[g] = std::max(wide_squares_[g], nominal_squares()[g]);
    }
  }

  const std::vector<double>& nominal_squares() const { return result_.fits[0].squares; }

  Fitter::Weights room(const Fit& fit, double share) const {
    return fitter_.roomy_weights(fitter_.squares(fit), share);
  }

  Fit settle(const Fit& fit) const {
    const Fit closer = damped_fit(fitter_, fit, kCloserIterations, room(fit, kCloser));
    return damped_fit(fitter_, closer, kLastIterations, fitter_.weights());
  }

  /// Each coordinate tried both ways, with a step that halves where neither helps: events in a
  /// rollout, such as an end stop that is met a tick later, make its squares ragged.
  Fit polish(Fit fit) const {
    constexpr double kFirst = 0.03, kLast = 2e-4;
    const auto weights = fitter_.weights();
    double samples = 0;
    for (const Group& group : fitter_.groups()) samples += group.holdout ? 0 : group.samples;
    double least = fitter_.objective(fit.effects, fit.x, weights);
    int left = options_.polish_steps;
    // Twenty times less than noise would leave: nothing more is to be had.
    for (double step = kFirst; step > kLast && left > 0 && least > 0.05 * 0.5 * samples;) {
      bool better = false;
      for (Eigen::Index i = 0; i < fit.x.size() && left > 0; ++i) {
        for (const double side : {1.0, -1.0}) {
          Eigen::VectorXd x = fit.x;
          x[i] += side * step;
          const double objective = fitter_.objective(fit.effects, x, weights);
          --left;
          if (!(objective < least)) continue;
          least = objective, fit.x = x, better = true;
          break;
        }
      }
      if (!better) step *= 0.5;
    }
    fit.objective = least;
    return fit;
  }

  /// Off by more than its noise, in the nominal model's rollout, in any recording.
  bool tells(const Group& group, double squares) const {
    return std::sqrt(squares / std::max(group.samples, 1.0)) > kQuiet * group.noise;
  }

  /// Physics of a joint shows at that joint's drive, or nowhere.
  bool may_act(const sim::EffectInfo& effect) const {
    const std::size_t at = effect.name.find('@');
    if (at == std::string_view::npos) return true;
    const std::string joint = std::string(effect.name.substr(at + 1)) + "_";
    for (std::size_t g = 0; g < fitter_.groups().size(); ++g) {
      const Group& group = fitter_.groups()[g];
      const std::string& name = fitter_.model().channels(group.recording)[group.channel];
      if (name.starts_with(joint) && tells(group, nominal_squares()[g])) return true;
    }
    return false;
  }

  /// All starts of all effects beside the nominal model, by what they promise.
  std::vector<LinearStart> look() {
    std::vector<LinearStart> starts;
    for (const sim::EffectInfo* effect : fitter_.model().effects()) {
      if (!may_act(*effect)) continue;
      for (LinearStart& start : starts_of(fitter_.model(), effect)) starts.push_back(start);
    }
    const LinearBase base(fitter_, result_.fits[0], look_weights_);
    for_all(starts.size(), 0.05, 0.2, "a first look at each effect",
            [&](std::size_t i) { starts[i].gain = base.beside(starts[i]).gain; });
    std::erase_if(starts, [](const LinearStart& s) { return !(s.gain > 0); });
    std::stable_sort(starts.begin(), starts.end(),
                     [](const LinearStart& a, const LinearStart& b) { return a.gain > b.gain; });
    return starts;
  }

  /// The most promising starts beside the nominal model: of each effect those that are not far
  /// behind its best, of no more than `effects` effects.
  std::vector<LinearStart> promising(int effects) const {
    std::vector<LinearStart> some;
    int there = 0;
    for (const LinearStart& start : looked_) {
      const auto of_same = [&start](const LinearStart& s) { return s.effect == start.effect; };
      const auto best = std::find_if(some.begin(), some.end(), of_same);
      const bool first = best == some.end();
      const auto count = std::count_if(some.begin(), some.end(), of_same);
      if (first ? there >= effects : count >= kStartsOfOne || start.gain < kNearBest * best->gain) {
        continue;
      }
      there += first ? 1 : 0;
      some.push_back(start);
    }
    return some;
  }

  /// Each start beside a base; of starts of one hypothesis the best fit stays.
  void fit_roughly(const LinearBase& base, const std::vector<LinearStart>& starts, double from,
                   double to, const std::string& what) {
    std::vector<Fit> fits(starts.size());
    for_all(starts.size(), from, to, what, [&](std::size_t i) {
      const Fit at = base.least_along(base.beside(starts[i]));
      fits[i] = damped_fit(fitter_, at, kRoughIterations, look_weights_);
      fits[i].squares = fitter_.squares(fits[i]);
    });
    for (Fit& fit : fits) {
      Fit* known = find_fit(fit.effects);
      if (known == nullptr) {
        result_.fits.push_back(std::move(fit));
      } else if (fit.objective < known->objective) {
        *known = std::move(fit);
      }
    }
  }

  /// To the end, the best of them without slopes, too.
  void follow(const std::vector<Effects>& hypotheses, double from, double to,
              const std::string& what) {
    std::vector<Fit> fits(hypotheses.size());
    for_all(hypotheses.size(), from, to, what, [&](std::size_t i) {
      fits[i] = settle(*find_fit(hypotheses[i]));
      fits[i].squares = fitter_.squares(fits[i]);
    });
    std::stable_sort(fits.begin(), fits.end(), [this](const Fit& a, const Fit& b) {
      return first_rank(fitter_, a) > first_rank(fitter_, b);
    });
    for_all(std::min(fits.size(), kPolished), to, to, what, [&](std::size_t i) {
      fits[i] = polish(fits[i]);
      fits[i].squares = fitter_.squares(fits[i]);
    });
    for (const Fit& fit : fits) *find_fit(fit.effects) = fit;
  }

  /// Once for each effect, not for each start: the scan has its own. Channels have the room that
  /// the setup as stated asks for, where it is more than what the refitted one leaves: a channel
  /// that the refit made small for the wrong reason, as soil stiffness does a foot's depth, else
  /// walls off the way to the truth.
  void scan_thresholds() {
    std::vector<LinearStart> scanned;
    for (const LinearStart& start : looked_) {
      const bool there =
          std::any_of(scanned.begin(), scanned.end(),
                      [&start](const LinearStart& s) { return s.effect == start.effect; });
      const bool enough = static_cast<int>(scanned.size()) >= options_.scanned;
      if (enough || there || threshold_of(fitter_.model(), start) < 0) continue;
      scanned.push_back(start);
    }
    const auto weights = fitter_.roomy_weights(wide_squares_, kRough);
    const LinearBase base(fitter_, Fit(result_.fits[0]), weights);
    for (std::size_t i = 0; i < scanned.size(); ++i) {
      const double from = 0.6 + 0.1 * double(i) / double(scanned.size());
      const ScanTasks tasks = [&](std::size_t count, const std::function<void(std::size_t)>& task) {
        for_all(count, from, from, "where an effect begins", task);
      };
      const auto fits = scan_threshold(fitter_, base, scanned[i], weights, tasks);
      if (!fits.empty()) take_scanned(fits[0]);
    }
  }

  void take_scanned(const Fit& scanned) {
    Fit fit = polish(settle(scanned));
    fit.squares = fitter_.squares(fit);
    Fit* known = find_fit(fit.effects);
    if (known == nullptr) {
      result_.fits.push_back(std::move(fit));
    } else if (first_rank(fitter_, fit) > first_rank(fitter_, *known)) {
      *known = std::move(fit);
    }
  }

  Fit* find_fit(const Effects& effects) {
    const auto found = std::find_if(result_.fits.begin(), result_.fits.end(),
                                    [&effects](const Fit& f) { return f.effects == effects; });
    return found == result_.fits.end() ? nullptr : &*found;
  }

  std::vector<Fit> ranked() const {
    std::vector<Fit> fits = result_.fits;
    std::stable_sort(fits.begin(), fits.end(), [this](const Fit& a, const Fit& b) {
      return first_rank(fitter_, a) > first_rank(fitter_, b);
    });
    return fits;
  }

  /// Hypotheses of so many effects, those of the list and others, best first.
  std::vector<Effects> best(std::size_t effects, int most) const {
    std::vector<Effects> some;
    for (const Fit& fit : ranked()) {
      const bool enough = static_cast<int>(some.size()) >= most;
      if (fit.effects.size() == effects && !enough) some.push_back(fit.effects);
    }
    return some;
  }

  /// What there was to explain is gone, of each channel.
  bool explained(const Fit& fit) const {
    for (std::size_t g = 0; g < fitter_.groups().size(); ++g) {
      const Group& group = fitter_.groups()[g];
      if (group.holdout || group.samples < 1) continue;
      const double left = std::sqrt(fit.squares[g] / group.samples);
      const double before = std::sqrt(nominal_squares()[g] / group.samples);
      if (left > kNearNoise * group.noise && left > kExplained * before) return false;
    }
    return true;
  }

  /// Partners are judged by their best start alone, once more beside each base.
  void fit_pairs() {
    say(0.7, "pairs");
    std::vector<LinearStart> partners;
    for (const LinearStart& start : looked_) {
      const bool there =
          std::any_of(partners.begin(), partners.end(),
                      [&start](const LinearStart& s) { return s.effect == start.effect; });
      if (start.effect->listed && !there) partners.push_back(start);
    }
    std::vector<Effects> bases = best(1, 1000);
    std::erase_if(bases, [](const Effects& effects) { return !listed(effects); });
    if (static_cast<int>(bases.size()) > options_.pair_bases) bases.resize(options_.pair_bases);
    const double step = 0.15 / std::max(1.0, double(bases.size()));
    double from = 0.7;
    for (const Effects& effects : bases) {
      const LinearBase base(fitter_, Fit(*find_fit(effects)), look_weights_);
      std::vector<LinearStart> pairs = partners;
      std::erase_if(pairs, [&](const LinearStart& s) { return s.effect == effects[0]; });
      for_all(pairs.size(), from, from + 0.3 * step, "pairs",
              [&](std::size_t i) { pairs[i].gain = base.beside(pairs[i]).gain; });
      std::stable_sort(pairs.begin(), pairs.end(),
                       [](const LinearStart& a, const LinearStart& b) { return a.gain > b.gain; });
      const auto most = static_cast<std::size_t>(options_.rough_pairs);
      if (pairs.size() > most) pairs.resize(most);
      fit_roughly(base, pairs, from + 0.3 * step, from + step, "pairs");
      from += step;
    }
    follow(best(2, options_.followed_pairs), 0.85, 0.95, "pairs");
  }

  /// With the noise as the best fit leaves it.
  void judge_all() {
    say(0.95, "contenders");
    for_all(result_.fits.size(), 0.95, 0.99, "contenders", [this](std::size_t i) {
      Fit& fit = result_.fits[i];
      fitter_.judge(fit);
      for (Eigen::Index c = 0; c < fit.x.size(); ++c) {
        fit.covariance(c, c) = std::max(fit.covariance(c, c), kLeastSigma * kLeastSigma);
      }
    });
  }

  Fitter& fitter_;
  const CostlyOptions& options_;
  SearchResult result_;
  std::vector<LinearStart> looked_;  // beside the nominal model, best first
  Fitter::Weights look_weights_;
  std::vector<double> wide_squares_;  // of the nominal model, as stated or refitted: the larger
  std::thread::id caller_ = std::this_thread::get_id();
};

}  // namespace

SearchResult costly_search(Fitter& fitter, const CostlyOptions& options) {
  return CostlySearch(fitter, options).run();
}

}  // namespace hoof::tools
