#include "tools/diagnose/search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tools/diagnose/noise_left.h"
#include "tools/diagnose/refit.h"
#include "tools/diagnose/search_start.h"

namespace hoof::tools {
namespace {

/// Of its start's size, where an effect does nothing to speak of.
constexpr double kAlmostNothing = 1e-4;
/// Starts of one hypothesis that gain this share less than its best after a rough fit are left.
constexpr double kBehind = 0.05;
/// Of the best, so many are fitted from other setups too, after each round.
constexpr std::size_t kAgain = 2;
/// So many of the best take what the best two found.
constexpr std::size_t kTakers = 10;
/// What gains less than this share of what the best effect does, each scaled as its linear step has
/// it and with the setup giving way, is no imitation; and so many are followed.
constexpr double kImitates = 0.5;
constexpr std::size_t kImitations = 4;
/// At the end so many are, of those whose objective is behind by more than this.
constexpr std::size_t kRivals = 6;
constexpr double kAsGood = 2;

class Search {
 public:
  Search(Fitter& fitter, const SearchOptions& options) : fitter_(fitter), options_(options) {}

  SearchResult run() {
    fit_nominal();
    fit_singles();
    fit_best_again(1, 0.4, 0.46, "one effect");
    fit_imitations();
    fit_pairs();
    fit_best_again(2, 0.68, 0.74, "pairs");
    fit_crosswise();
    take_noise_of_best();
    fit_contenders();
    fit_best_again(2, 0.95, 0.96, "contenders");
    fit_rivals();
    say(1, "done");
    return std::move(result_);
  }

 private:
  void say(double share, const std::string& what) const {
    if (options_.progress && !options_.progress(share, what)) throw SearchStopped();
  }

  void fit_nominal() {
    say(0, "nominal model");
    const Layout layout(fitter_.model(), {});
    Fit nominal;
    nominal.x = layout.stated();
    nominal = settle(nominal);
    held_ = restrained();
    Fit other = settle(held_);
    if (other.objective < nominal.objective) nominal = std::move(other);
    fitter_.judge(nominal);
    result_.fits = {nominal};
  }

  Fit settle(Fit fit) const { return tools::settle(fitter_, std::move(fit), options_.iterations); }

  /// The best so far, of so many effects at most, from other setups than where they were found; of
  /// a pair that leads its members too, which must not lose against it only because they are stuck.
  void fit_best_again(std::size_t effects, double from, double to, const std::string& what) {
    std::vector<Fit> fits = ranked();
    std::erase_if(fits, [effects](const Fit& f) {
      return f.effects.empty() || f.effects.size() > effects || !listed(f.effects);
    });
    std::vector<Fit> best;
    for (Fit& fit : fits) {
      const bool member = !best.empty() && best.front().effects.size() > fit.effects.size() &&
                          part_of(fit.effects, best.front().effects);
      if (best.size() < kAgain || member) best.push_back(std::move(fit));
    }
    run_all(best.size(), from, to, what, [&](std::size_t i) {
      best[i] = fit_again(fitter_, best[i], options_.iterations);
      fitter_.judge(best[i]);
    });
    for (Fit& fit : best) keep(std::move(fit));
  }

  /// Runs task(0..count-1) on the threads and says how far it is.
  void run_all(std::size_t count, double from, double to, const std::string& what,
               const std::function<void(std::size_t)>& task) {
    std::atomic<int> done{0};
    for_each_task(static_cast<int>(count), options_.threads, [&](int i) {
      task(static_cast<std::size_t>(i));
      const double share = ++done / static_cast<double>(count);
      if (std::this_thread::get_id() == caller_) say(from + (to - from) * share, what);
    });
  }

  /// Of each hypothesis the best fit stays.
  void keep(Fit fit) {
    for (Fit& known : result_.fits) {
      if (known.effects != fit.effects) continue;
      if (fit.objective < known.objective) known = std::move(fit);
      return;
    }
    result_.fits.push_back(std::move(fit));
  }

  void follow(const std::vector<SearchStart>& candidates, double from, double to,
              const std::string& what, bool anew = true) {
    std::vector<Fit> fits(candidates.size());
    run_all(candidates.size(), from, to, what, [&](std::size_t i) {
      fits[i] = anew ? follow_one(candidates[i])
                     : fitter_.fit(candidates[i].effects, candidates[i].x, options_.iterations,
                                   fitter_.weights());
      fitter_.judge(fits[i]);
    });
    for (Fit& fit : fits) keep(std::move(fit));
  }

  /// A hypothesis holds the nominal model, and a pair each of its members: one that comes out worse
  /// than what it holds went astray, and is followed once more from there.
  Fit follow_one(const SearchStart& candidate) const {
    Fit fit = settle(best_size(candidate));
    for (const Fit& simpler : result_.fits) {
      const bool held = simpler.effects.size() < candidate.effects.size() &&
                        part_of(simpler.effects, candidate.effects);
      if (!held || fit.objective <= simpler.objective) continue;
      Eigen::VectorXd x = carried(fitter_.model(), simpler, candidate.effects, candidate.x);
      make_small(x, candidate.effects, simpler.effects);
      Fit again = fitter_.fit(candidate.effects, x, options_.iterations, fitter_.weights());
      if (again.objective < fit.objective) fit = std::move(again);
    }
    return fit;
  }

  /// Effects that are not among `there` at almost no size, where they have one.
  void make_small(Eigen::VectorXd& x, const Effects& effects, const Effects& there) const {
    int at = Layout(fitter_.model(), {}).setup_count();
    const int setup = at;
    for (const sim::EffectInfo* effect : effects) {
      if (std::find(there.begin(), there.end(), effect) == there.end()) {
        const Layout alone(fitter_.model(), {effect});
        const auto starts = alone.starts(x);
        const int size = starts.empty() ? -1 : starts[0].size_coordinate;
        if (size >= 0) {
          double& value = x[at + size - setup];
          const bool by_log = alone.of_effect(size - setup).parameter->logarithmic;
          value = by_log ? value + std::log(kAlmostNothing) : value * kAlmostNothing;
        }
      }
      at += static_cast<int>(effect->parameters.size());
    }
  }

  /// The best of all hand what they found, of the setup and of the effects that they share, to
  /// their rivals, which may have been stuck.
  void fit_crosswise() {
    say(0.74, "from one another");
    constexpr std::size_t kDonors = 2;
    std::vector<Fit> best = ranked();
    best.resize(std::min(best.size(), kTakers));
    // The nominal model among them always: what it can do by itself is no missing physics.
    best.push_back(result_.fits[0]);
    std::vector<SearchStart> again;
    for (std::size_t d = 0; d < std::min(kDonors, best.size()); ++d) {
      if (best[d].effects.empty()) continue;
      for (std::size_t i = 0; i < best.size(); ++i) {
        const bool share =
            std::any_of(best[i].effects.begin(), best[i].effects.end(),
                        [&](const sim::EffectInfo* e) { return part_of({e}, best[d].effects); });
        if (i == d || (!share && !best[i].effects.empty())) continue;
        again.push_back({best[i].effects,
                         carried(fitter_.model(), best[d], best[i].effects, best[i].x),
                         {},
                         0,
                         -1,
                         false,
                         true});
      }
    }
    follow(again, 0.74, 0.8, "from one another", false);
  }

  /// The candidate at the size, of some, that leaves least: a linear step may go too far. The other
  /// coordinates stay, or give way as a linear step has it.
  Fit best_size(const SearchStart& candidate) const {
    Fit fit;
    fit.effects = candidate.effects;
    fit.x = candidate.x;
    if (candidate.sized) return fit;
    const auto weights = candidate.weights ? *candidate.weights
                                           : fitter_.roomy_weights(result_.fits[0].squares, 0.5);
    double least = 1e300;
    for (const double scale : {1.0, 0.4, 0.15, 0.05, 0.01, 1e-3}) {
      Eigen::VectorXd x = candidate.x;
      if (candidate.size_coordinate >= 0) {
        double& size = x[candidate.size_coordinate];
        size = candidate.by_log ? size + std::log(scale) : size * scale;
      } else if (scale < 1) {
        break;
      }
      for (const double share : {0.0, 1.0}) {
        if (share > 0 && candidate.give.size() == 0) continue;
        const Eigen::VectorXd at = share > 0 ? x + share * scale * candidate.give : x;
        const double objective = fitter_.objective(fit.effects, at, weights);
        if (objective < least) least = objective, fit.x = at;
      }
    }
    return fit;
  }

  std::vector<SearchStart> look_beside(const Fit& base, int starts) {
    return look_beside(base, starts, fitter_.roomy_weights(base.squares, 0.3));
  }

  std::vector<SearchStart> look_beside(const Fit& base, int starts,
                                       const Fitter::Weights& weights) {
    const Tangent t = tangent(fitter_, base, weights);
    const auto& effects = fitter_.model().effects();
    std::vector<std::vector<SearchStart>> found(effects.size());
    for_each_task(static_cast<int>(effects.size()), options_.threads, [&](int i) {
      const bool there =
          std::find(base.effects.begin(), base.effects.end(), effects[i]) != base.effects.end();
      if (!there) found[i] = starts_beside(fitter_, base, t, effects[i], weights);
    });
    std::vector<SearchStart> all;
    for (auto& list : found) {
      if (static_cast<int>(list.size()) > starts) list.resize(starts);
      const double least = list.empty() ? 0 : 0.3 * std::abs(list[0].gain);
      std::erase_if(
          list, [least](const SearchStart& c) { return c.size_coordinate >= 0 && c.gain < least; });
      for (SearchStart& c : list) all.push_back(std::move(c));
    }
    return all;
  }

  /// The nominal model with its setup held near what was stated, and where it follows the
  /// recordings only. Where physics is missing the setup of the best nominal fit stands in for it,
  /// tens of sigmas away; and a swing of which it has lost the phase pulls it anywhere.
  Fit restrained() {
    constexpr double kPull = 40;  // samples' worth that the recordings pull with
    Fit fit;
    fit.x = Layout(fitter_.model(), {}).stated();
    double samples = 1;
    for (const Group& g : fitter_.groups()) samples += g.holdout ? 0 : g.samples;
    for (int round = 0; round < 2; ++round) {
      const auto until = fitter_.followed_until(fit);
      Fitter::Weights weights = fitter_.roomy_weights(fitter_.squares(fit, until), 1);
      weights.until = until;
      for (double& w : weights.scale) w *= std::sqrt(kPull / samples);
      fit = fitter_.fit({}, fit.x, 4, weights, 1e-3);
    }
    const auto until = fitter_.followed_until(fit);
    fit.squares = fitter_.squares(fit, until);
    rough_weights_ = fitter_.roomy_weights(fit.squares, 0.5);
    rough_weights_.until = until;
    return fit;
  }

  void fit_singles() {
    say(0.05, "one effect");
    std::vector<SearchStart> singles = look_beside(result_.fits[0], options_.fits_of_single);
    Fitter::Weights weights = fitter_.roomy_weights(held_.squares, 0.3);
    weights.until = rough_weights_.until;
    for (SearchStart& c : look_beside(held_, options_.fits_of_single, weights)) {
      c.weights = &rough_weights_;
      singles.push_back(std::move(c));
    }
    follow(most_promising(singles, options_.follow_singles), 0.1, 0.4, "one effect");
  }

  /// What may do the work of the best single effect: the others beside the setup that it found, its
  /// own work taken away. From the nominal fit, whose setup stands in for the physics that is
  /// missing, such rivals go astray, and what cannot be told apart would look as if it could.
  std::vector<SearchStart> imitations(const Fit& best) {
    Fit base;
    base.x = best.x.head(Layout(fitter_.model(), {}).setup_count());
    base.squares = fitter_.squares(base);
    const auto weights = fitter_.roomy_weights(base.squares, 0.3);
    std::vector<SearchStart> starts = look_beside(base, 1, weights);
    double own = 0;
    for (const SearchStart& c : starts) own = c.effects == best.effects ? c.gain : own;
    std::erase_if(starts, [&](const SearchStart& c) {
      return c.effects == best.effects || !listed(c.effects) || c.gain < kImitates * own;
    });
    std::stable_sort(starts.begin(), starts.end(),
                     [](const SearchStart& a, const SearchStart& b) { return a.gain > b.gain; });
    return starts;
  }

  std::vector<Fit> listed_singles() const {
    std::vector<Fit> singles = ranked();
    std::erase_if(singles,
                  [](const Fit& f) { return f.effects.size() != 1 || !f.effects[0]->listed; });
    return singles;
  }

  void fit_imitations() {
    const std::vector<Fit> singles = listed_singles();
    if (singles.empty()) return;
    std::vector<SearchStart> starts = imitations(singles.front());
    if (starts.size() > kImitations) starts.resize(kImitations);
    follow(starts, 0.46, 0.5, "imitations");
  }

  /// Once more at the end, beside what is the best now: what a linear step has as its equal and a
  /// fit does not is likely stuck, and is fitted from other setups too.
  void fit_rivals() {
    const std::vector<Fit> singles = listed_singles();
    if (singles.empty()) return;
    const Fit& best = singles.front();
    std::vector<SearchStart> starts = imitations(best);
    std::erase_if(starts, [&](const SearchStart& c) {
      return std::any_of(singles.begin(), singles.end(), [&](const Fit& f) {
        return f.effects == c.effects && f.objective < best.objective + kAsGood;
      });
    });
    if (starts.size() > kRivals) starts.resize(kRivals);
    follow(starts, 0.96, 0.97, "rivals");
    std::vector<Fit> rivals;
    for (const Fit& fit : result_.fits) {
      const bool followed = std::any_of(starts.begin(), starts.end(), [&fit](const SearchStart& c) {
        return c.effects == fit.effects;
      });
      if (followed && fit.objective > best.objective + kAsGood) rivals.push_back(fit);
    }
    run_all(rivals.size(), 0.97, 1, "rivals", [&](std::size_t i) {
      rivals[i] = fit_again(fitter_, rivals[i], options_.iterations);
      fitter_.judge(rivals[i]);
    });
    for (Fit& fit : rivals) keep(std::move(fit));
  }

  /// After a rough fit of each: of several starts of one hypothesis those that are not behind its
  /// best, and no more hypotheses than `most`.
  std::vector<SearchStart> most_promising(std::vector<SearchStart> candidates, int most) {
    if (options_.rough_iterations <= 0) return candidates;
    const auto weights = fitter_.roomy_weights(result_.fits[0].squares, 0.5);
    const double nominal = fitter_.objective({}, result_.fits[0].x, weights);
    for_each_task(static_cast<int>(candidates.size()), options_.threads, [&](int i) {
      SearchStart& c = candidates[i];
      c.x = fitter_
                .fit(c.effects, best_size(c).x, options_.rough_iterations,
                     c.weights ? *c.weights : weights, 1e-3)
                .x;
      c.gain = nominal - fitter_.objective(c.effects, c.x, weights);
      c.sized = true;
    });
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const SearchStart& a, const SearchStart& b) { return a.gain > b.gain; });
    std::vector<SearchStart> ahead;
    int hypotheses = 0;
    for (SearchStart& c : candidates) {
      const auto best = std::find_if(ahead.begin(), ahead.end(), [&c](const SearchStart& other) {
        return other.effects == c.effects;
      });
      const bool first = best == ahead.end();
      if (first ? hypotheses >= most : c.gain < (1 - kBehind) * best->gain) continue;
      hypotheses += first ? 1 : 0;
      ahead.push_back(std::move(c));
    }
    return ahead;
  }

  void fit_pairs() {
    say(0.5, "pairs");
    std::vector<Fit> singles = listed_singles();
    if (static_cast<int>(singles.size()) > options_.pair_bases) singles.resize(options_.pair_bases);
    std::vector<SearchStart> pairs;
    for (const Fit& base : singles) {
      for (SearchStart& c : look_beside(base, 1)) {
        if (!c.effects.back()->listed) continue;
        c.gain += first_rank(fitter_, base) - first_rank(fitter_, result_.fits[0]);
        pairs.push_back(std::move(c));
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const SearchStart& a, const SearchStart& b) { return a.gain > b.gain; });
    // The same pair from both sides is worth two starts, not more.
    if (static_cast<int>(pairs.size()) > options_.pair_fits) pairs.resize(options_.pair_fits);
    for (SearchStart& pair : pairs) put_in_order(pair);
    pairs = most_promising(std::move(pairs), options_.follow_pairs);
    follow(pairs, 0.55, 0.68, "pairs");
  }

  /// Effects of a pair in the order of their names, as in the catalogue, so that both ways round
  /// are one hypothesis; not of their addresses, which differ from run to run.
  void put_in_order(SearchStart& pair) const {
    if (pair.effects[0]->name < pair.effects[1]->name) return;
    const auto first = static_cast<Eigen::Index>(pair.effects[0]->parameters.size());
    const auto second = static_cast<Eigen::Index>(pair.effects[1]->parameters.size());
    const Eigen::Index setup = pair.x.size() - first - second;
    Eigen::VectorXd x(pair.x.size());
    x << pair.x.head(setup), pair.x.tail(second), pair.x.segment(setup, first);
    pair.x = x;
    if (pair.give.size() > 0) {
      const Eigen::VectorXd give = pair.give;
      pair.give << give.head(setup), give.tail(second), give.segment(setup, first);
    }
    if (pair.size_coordinate >= setup + first) {
      pair.size_coordinate -= static_cast<int>(first);
    }
    std::swap(pair.effects[0], pair.effects[1]);
  }

  std::vector<Fit> ranked() const {
    std::vector<Fit> fits = result_.fits;
    std::stable_sort(fits.begin(), fits.end(), [this](const Fit& a, const Fit& b) {
      return first_rank(fitter_, a) > first_rank(fitter_, b);
    });
    return fits;
  }

  void take_noise_of_best();

  void fit_contenders() {
    say(0.8, "contenders");
    std::vector<Fit> fits = ranked();
    const Fit nominal = result_.fits[0];
    std::vector<SearchStart> again = {{nominal.effects, nominal.x, {}, 0, -1, false}};
    for (const Fit& fit : fits) {
      if (!fit.effects.empty() && static_cast<int>(again.size()) < options_.contenders) {
        again.push_back({fit.effects, fit.x, {}, 0, -1, false});
      }
    }
    std::vector<Fit> others;
    for (const Fit& fit : fits) {
      const bool contends = std::any_of(again.begin(), again.end(), [&fit](const SearchStart& c) {
        return c.effects == fit.effects;
      });
      if (!contends) others.push_back(fit);
    }
    result_.fits.clear();
    follow(again, 0.8, 0.95, "contenders", false);
    for_each_task(static_cast<int>(others.size()), options_.threads,
                  [&](int i) { fitter_.judge(others[i]); });
    for (Fit& fit : others) result_.fits.push_back(std::move(fit));
  }

  Fitter& fitter_;
  const SearchOptions& options_;
  SearchResult result_;
  Fit held_;                       // restrained()
  Fitter::Weights rough_weights_;  // where the nominal model follows the recordings
  std::thread::id caller_ = std::this_thread::get_id();
};

void Search::take_noise_of_best() {
  take_noise_left(fitter_, ranked().front());
}

}  // namespace

double first_rank(const Fitter& fitter, const Fit& fit) {
  double likelihood = 0, samples = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (group.holdout || group.samples < 1) continue;
    const double least = kLeastVariance * group.noise * group.noise;
    const double variance = std::max(fit.squares[g] / group.samples, least);
    likelihood -= 0.5 * group.samples * std::log(variance);
    samples += group.samples;
  }
  for (const sim::EffectInfo* effect : fit.effects)
    likelihood -= fitter.model().complexity(*effect);
  return likelihood - 0.5 * static_cast<double>(fit.x.size()) * std::log(std::max(samples, 2.0));
}

SearchResult search(Fitter& fitter, const SearchOptions& options) {
  return Search(fitter, options).run();
}

}  // namespace hoof::tools
