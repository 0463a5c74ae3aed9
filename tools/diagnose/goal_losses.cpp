#include "tools/diagnose/goal_losses.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

using sim::PendulumInputs;
using sim::PendulumLaw;
using sim::PendulumSettings;

// Set on concealed plants, seeds 88001 and 88002.
constexpr std::size_t kLongest = 120;  // samples that a burst may last
constexpr double kMostLate_s = 0.1;    // by which all goals may come late
constexpr double kBurst = 10;          // log probability that one begins, at a sample
constexpr double kMostSquare = 25;  // a sample that fits nothing counts no more, over all channels
constexpr double kHopeless = 40;    // behind the likeliest, in log likelihood: given up
constexpr double kLearn_s = 0.3;    // in which an unknown torque is learnt: longer than bursts are
constexpr double kMostUnknown = 0.5;  // of gravity's torque; and Coulomb friction on top
constexpr std::size_t kWaysOn = 6;    // kept where goals arrive again
constexpr double kMostMemory = 0.7;   // from sample to sample, of what is left
constexpr int kPasses = 3;            // each with the noise that the one before leaves

/// Goals, supply and switch at each evaluation of the law, and the steps about each sample.
class Clock {
 public:
  Clock(const PendulumSettings& s, const PendulumInputs& in, double longest_step_s) : in_(in) {
    const double period = s.control_period_s > 0 ? s.control_period_s : longest_step_s;
    steps_per_law = std::max(1, static_cast<int>(std::ceil(period / longest_step_s - 1e-9)));
    h = period / steps_per_law;
    const auto& t = in.time_s;
    for (std::size_t i = 0; i < t.size(); ++i) {
      at.push_back(step_after(t[i]));
      until.push_back(i + 1 < t.size() ? step_after(0.5 * (t[i] + t[i + 1])) : at.back());
    }
    const long laws = until.back() / steps_per_law + 1;
    std::size_t i = 0;
    for (long k = 0; k < laws; ++k) {
      const double now = t.front() + static_cast<double>(k) * period;
      while (i + 1 < t.size() && t[i + 1] <= now) ++i;
      supply_V.push_back(in.supply_V.empty() ? s.supply_V : in.supply_V[i]);
      // It turns in the middle of two samples for all that is known, as in the rig's model.
      const bool past = i + 1 < t.size() && now > 0.5 * (t[i] + t[i + 1]);
      enabled.push_back(in.enable.empty() || in.enable[past ? i + 1 : i] > 0.5);
    }
    position.resize(laws), velocity.resize(laws), torque.resize(laws);
  }

  /// Goals that come `late_s` after the time that the recording gives them.
  void read_goals(double late_s) {
    const auto& t = in_.time_s;
    std::size_t i = 0;
    for (std::size_t k = 0; k < position.size(); ++k) {
      const double now =
          std::max(t.front() + static_cast<double>(k) * steps_per_law * h - late_s, t.front());
      while (i + 1 < t.size() && t[i + 1] <= now) ++i;
      position[k] = between(in_.position_goal_rad, in_.position_goal_bend_rad_s, i, now);
      velocity[k] = between(in_.velocity_goal_rad_s, in_.velocity_goal_bend_rad_s2, i, now);
      torque[k] = between(in_.torque_ff_Nm, in_.torque_ff_bend_Nm_s, i, now);
    }
  }

  double time_s(long step) const { return in_.time_s.front() + static_cast<double>(step) * h; }

  double h = 0;
  int steps_per_law = 1;
  std::vector<long> at, until;  // first step at or after a sample; and the middle to the next
  std::vector<double> position, velocity, torque, supply_V;  // per evaluation of the law
  std::vector<bool> enabled;

 private:
  long step_after(double t_s) const {
    return static_cast<long>(std::ceil((t_s - in_.time_s.front()) / h - 1e-9));
  }
  double between(std::span<const double> values, std::span<const sim::SlopeOffset> bends,
                 std::size_t i, double t_s) const {
    if (values.empty()) return 0;
    if (i + 1 >= values.size()) return values[i];
    const double span = in_.time_s[i + 1] - in_.time_s[i];
    const double x = (t_s - in_.time_s[i]) / span;
    double value = values[i] + x * (values[i + 1] - values[i]);
    if (!bends.empty()) value += span * x * (1 - x) * ((1 - x) * bends[i].start - x * bends[i].end);
    return value;
  }

  const PendulumInputs& in_;
};

/// The joint with its drive, and what is held against it so far.
struct Track {
  double q = 0, w = 0;                          // at the next step
  double position = 0, velocity = 0, feed = 0;  // goal in force
  double command_Nm = 0;                        // as recorded; by the last step
  double law_Nm = 0, duty = 0, volt = 0;        // since the last evaluation of the law
  bool on = true;                               // likewise
  double unknown_Nm = 0;                        // that pulls at the link
  double cost = 0;
  std::size_t began = 0;  // sample
  int last = -1;          // burst before
};

struct Burst {
  long from = 0, until = 0;  // evaluations of the law, the second not in it
  int before = -1;
};
using Bursts = std::vector<Burst>;  // in their order

class LossSearch {
 public:
  LossSearch(const PendulumSettings& s, const PendulumInputs& in, const sim::PendulumStart& start,
             std::span<const LossChannel> channels, std::span<const LossDoubt> doubts,
             double longest_step_s)
      : stated_(s), in_(in), channels_(channels), doubts_(doubts), clock_(s, in, longest_step_s) {
    set(s);
    start_.q = start.position_rad;
    start_.w = start.velocity_rad_s;
  }

  GoalLosses run();

 private:
  void set(const PendulumSettings& s);
  void fit_settings(const Bursts& bursts);
  void step(Track& track, long k, bool lost) const;
  void advance(Track& track, long from, long until, bool lost) const;
  double residual(const LossChannel& channel, const Track& track, std::size_t i) const;
  void learn(Track& track, std::size_t i) const;
  double half_square(const Track& track, std::size_t i) const;
  template <typename See>
  void run_along(const Bursts& bursts, See see) const;
  std::vector<std::vector<double>> residuals(const Bursts& bursts) const;
  double cost_of(const Bursts& bursts) const;
  void choose_lateness();
  void weigh(std::size_t channel, std::span<const double> left, bool memory);
  Bursts most_likely() const;
  Bursts without_idle(Bursts bursts) const;
  void sharpen(Bursts& bursts) const;

  const PendulumSettings& stated_;
  PendulumSettings s_;
  const PendulumInputs& in_;
  std::span<const LossChannel> channels_;
  std::span<const LossDoubt> doubts_;
  Clock clock_;
  double inertia_ = 0, gravity_Nm_ = 0, stiffness_Nm_rad_ = 0;
  Track start_;
  bool learning_ = true;
  std::vector<double> sigma_, new_;  // per channel: noise; share of a sample that is news
};

void LossSearch::step(Track& x, long k, bool lost) const {
  if (k % clock_.steps_per_law == 0) {
    const long law = k / clock_.steps_per_law;
    if (!lost) {
      x.position = clock_.position[law];
      x.velocity = clock_.velocity[law];
      x.feed = clock_.torque[law];
    }
    const double error = x.position - x.q;
    if (s_.law == PendulumLaw::kDuty) {
      x.duty = std::clamp(s_.kp_duty * s_.counts_per_rad * error / sim::kDutyCounts, -1.0, 1.0);
      x.volt = clock_.supply_V[law];
    } else {
      x.law_Nm = std::clamp(s_.kp_Nm_rad * error + s_.kd_Nm_s_rad * (x.velocity - x.w) + x.feed,
                            -s_.torque_limit_Nm, s_.torque_limit_Nm);
    }
    x.on = clock_.enabled[law];
  }
  const double asked = s_.law == PendulumLaw::kDuty
                           ? s_.kt_Nm_A / s_.resistance_ohm * (x.duty * x.volt - s_.kt_Nm_A * x.w)
                           : x.law_Nm;
  x.command_Nm = x.on ? asked : 0;
  const double h = clock_.h;
  const double push = x.command_Nm + x.unknown_Nm - gravity_Nm_ * std::sin(x.q + 0.5 * h * x.w);
  // Friction takes speed until there is none.
  const double half = 0.5 * h * s_.viscous_Nm_s_rad / inertia_;
  const double free = ((1 - half) * x.w + h * push / inertia_) / (1 + half);
  const double stop = h * s_.coulomb_Nm / inertia_ / (1 + half);
  const double w = std::abs(free) <= stop ? 0 : free - std::copysign(stop, free);
  x.q += 0.5 * h * (x.w + w);
  x.w = w;
}

void LossSearch::advance(Track& track, long from, long until, bool lost) const {
  for (long k = from; k < until; ++k) step(track, k, lost);
}

/// NaN where nothing tells: the sample is missing, or the drive is off.
double LossSearch::residual(const LossChannel& channel, const Track& x, std::size_t i) const {
  if (!x.on) return std::nan("");
  const double back = clock_.time_s(clock_.at[i]) - in_.time_s[i];
  switch (channel.kind) {
    case LossChannel::kPosition:
      return channel.values[i] - (x.q - back * x.w);
    case LossChannel::kVelocity:
      return channel.values[i] - x.w;
    case LossChannel::kTorque:
      break;
  }
  return channel.values[i] - x.command_Nm;
}

/// What the stated setup misses of slow torques is learnt along the way: where gravity's is off, a
/// soft loop hangs beside its goal all the time.
void LossSearch::learn(Track& track, std::size_t i) const {
  const double error = in_.position_rad[i] - track.q;
  if (i == 0 || !learning_ || !std::isfinite(error)) return;
  const double share = std::min((in_.time_s[i] - in_.time_s[i - 1]) / kLearn_s, 1.0);
  track.q += 2 * share * error;
  track.w += share * error / kLearn_s;
  // A drive that is off or at its limit does not hang beside its goal by its stiffness.
  const bool clipped = s_.law == PendulumLaw::kDuty ? std::abs(track.duty) >= 1
                                                    : std::abs(track.law_Nm) >= s_.torque_limit_Nm;
  if (clipped || !track.on) return;
  const double most = kMostUnknown * gravity_Nm_ + s_.coulomb_Nm;
  track.unknown_Nm = std::clamp(track.unknown_Nm + stiffness_Nm_rad_ * error * share, -most, most);
}

double LossSearch::half_square(const Track& track, std::size_t i) const {
  double sum = 0;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const double r = residual(channels_[c], track, i);
    if (!std::isfinite(r)) continue;
    sum += new_[c] * r * r / (sigma_[c] * sigma_[c]);
  }
  return 0.5 * std::min(sum, kMostSquare);
}

/// The joint along the whole recording, `see` called with each sample and its track.
template <typename See>
void LossSearch::run_along(const Bursts& bursts, See see) const {
  Track track = start_;
  long k = 0;
  auto burst = bursts.begin();
  const auto run_to = [&](long until) {
    for (; k < until; ++k) {
      const long law = k / clock_.steps_per_law;
      while (burst != bursts.end() && burst->until <= law) ++burst;
      step(track, k, burst != bursts.end() && burst->from <= law);
    }
  };
  for (std::size_t i = 0; i < in_.time_s.size(); ++i) {
    run_to(clock_.at[i]);
    see(i, track);
    learn(track, i);
    run_to(clock_.until[i]);
  }
}

std::vector<std::vector<double>> LossSearch::residuals(const Bursts& bursts) const {
  std::vector<std::vector<double>> left(channels_.size());
  run_along(bursts, [&](std::size_t i, const Track& track) {
    for (std::size_t c = 0; c < channels_.size(); ++c) {
      const double r = residual(channels_[c], track, i);
      if (std::isfinite(r)) left[c].push_back(r);
    }
  });
  return left;
}

double LossSearch::cost_of(const Bursts& bursts) const {
  double sum = 0;
  run_along(bursts, [&](std::size_t i, const Track& track) { sum += half_square(track, i); });
  return sum;
}

double median_size(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// That which leaves the least, in the middle of what each channel leaves. Sets sigma_ to that.
void LossSearch::choose_lateness() {
  const auto& t = in_.time_s;
  const double sample_s = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  double least = 1e300, best_s = 0;
  for (double late_s = 0; late_s <= kMostLate_s; late_s += 0.5 * sample_s) {
    clock_.read_goals(late_s);
    const auto left = residuals({});
    double sum = 0;
    std::vector<double> sigma;
    for (std::size_t c = 0; c < left.size(); ++c) {
      const double usual = left[c].empty() ? 0 : 1.4826 * median_size(left[c]);
      sigma.push_back(std::max({usual, channels_[c].noise, 1e-12}));
      sum += std::log(sigma.back());
    }
    if (sum < least) least = sum, best_s = late_s, sigma_ = sigma;
  }
  clock_.read_goals(best_s);
}

Bursts LossSearch::most_likely() const {
  const std::size_t n = in_.time_s.size();
  Bursts ended;
  const auto law_before = [this](std::size_t i) {
    const long step = i > 0 ? clock_.until[i - 1] : 0;
    return (step + clock_.steps_per_law - 1) / clock_.steps_per_law;
  };
  std::vector<Track> fresh = {start_}, held;  // goals arrive; the last one is held
  const auto cheaper = [](const Track& a, const Track& b) { return a.cost < b.cost; };
  long k = 0;
  for (std::size_t i = 0; i < n; ++i) {
    // Half a sample before i: a burst may begin, or have ended. What ends is not at once the only
    // way to go on: a joint that is a little off its true state costs more only later.
    Track holds = *std::min_element(fresh.begin(), fresh.end(), cheaper);
    holds.cost += kBurst;
    holds.began = i;
    const auto ends = std::min_element(held.begin(), held.end(), cheaper);
    if (ends != held.end() && ends->cost < holds.cost) {
      ended.push_back({law_before(ends->began), law_before(i), ends->last});
      fresh.push_back(*ends);
      fresh.back().last = static_cast<int>(ended.size()) - 1;
      fresh.back().began = 0;
    }
    std::stable_sort(fresh.begin(), fresh.end(), cheaper);
    if (fresh.size() > kWaysOn) fresh.resize(kWaysOn);
    if (i > 0) held.push_back(holds);
    const auto advance_all = [&](long until) {
      for (Track& track : fresh) advance(track, k, until, false);
      for (Track& track : held) advance(track, k, until, true);
      k = until;
    };
    advance_all(clock_.at[i]);
    for (std::vector<Track>* tracks : {&fresh, &held}) {
      for (Track& track : *tracks) {
        track.cost += half_square(track, i);
        learn(track, i);
      }
    }
    advance_all(clock_.until[i]);
    const double least = std::min_element(fresh.begin(), fresh.end(), cheaper)->cost;
    const auto hopeless = [&](const Track& x) { return x.cost > least + kHopeless; };
    std::erase_if(fresh, hopeless);
    std::erase_if(held, [&](const Track& x) { return hopeless(x) || i - x.began >= kLongest; });
  }
  fresh.insert(fresh.end(), held.begin(), held.end());
  const auto best = std::min_element(fresh.begin(), fresh.end(), cheaper);
  Bursts bursts;
  if (best->began > 0) bursts.push_back({law_before(best->began), law_before(n)});
  for (int b = best->last; b >= 0; b = ended[b].before) bursts.push_back(ended[b]);
  std::reverse(bursts.begin(), bursts.end());
  return bursts;
}

void LossSearch::set(const PendulumSettings& s) {
  s_ = s;
  inertia_ = std::max(s.link_inertia_kg_m2() + s.armature_kg_m2, 1e-9);
  gravity_Nm_ = s.gravity_torque_Nm();
  stiffness_Nm_rad_ = s.kp_Nm_rad;
  if (s.law != PendulumLaw::kDuty) return;
  stiffness_Nm_rad_ = s.kt_Nm_A / s.resistance_ohm * clock_.supply_V.front() * s.kp_duty *
                      s.counts_per_rad / sim::kDutyCounts;
}

/// Doubtful settings, one after the other, by ever smaller steps: a joint heavier than stated
/// overshoots as if a goal had been held.
void LossSearch::fit_settings(const Bursts& bursts) {
  const auto cost = [&](const PendulumSettings& s) {
    set(s);
    double sum = cost_of(bursts);
    for (const LossDoubt& doubt : doubts_) {
      const double off = (s.*doubt.setting - stated_.*doubt.setting) / doubt.sigma;
      sum += 0.5 * off * off;
    }
    return sum;
  };
  PendulumSettings best = s_;
  double least = cost(best);
  for (const double step : {1.0, 0.5, 0.25, 0.12, 0.06}) {
    for (const LossDoubt& doubt : doubts_) {
      for (const double way : {step, -step}) {
        PendulumSettings moved = best;
        moved.*doubt.setting = std::max(moved.*doubt.setting + way * doubt.sigma, 0.0);
        const double now = cost(moved);
        if (now >= least) continue;
        least = now;
        best = moved;
        break;
      }
    }
  }
  set(best);
}

/// Without the bursts that do not pay for themselves once all of them are known.
Bursts LossSearch::without_idle(Bursts bursts) const {
  double cost = cost_of(bursts);
  for (std::size_t b = 0; b < bursts.size();) {
    Bursts fewer = bursts;
    fewer.erase(fewer.begin() + static_cast<long>(b));
    const double without = cost_of(fewer);
    if (without > cost + kBurst) {
      ++b;
      continue;
    }
    bursts = std::move(fewer);
    cost = without;
  }
  return bursts;
}

/// Their ends to the evaluation of the law, where until now they lay in the middle of two samples.
void LossSearch::sharpen(Bursts& bursts) const {
  const auto laws = static_cast<long>(clock_.position.size());
  const auto n = static_cast<long>(in_.time_s.size());
  const long most = std::max(1L, (laws + n - 1) / n);
  double cost = cost_of(bursts);
  const auto move = [&](std::size_t b, long Burst::*end, long by) {
    Bursts moved = bursts;
    moved[b].*end += by;
    const long before = b > 0 ? moved[b - 1].until : 1;
    const long after = b + 1 < moved.size() ? moved[b + 1].from : laws;
    if (moved[b].from < before || moved[b].until > after || moved[b].until <= moved[b].from) return;
    const double now = cost_of(moved);
    if (now < cost) cost = now, bursts = std::move(moved);
  };
  for (std::size_t b = 0; b < bursts.size(); ++b) {
    for (long Burst::*end : {&Burst::from, &Burst::until}) {
      const long found = bursts[b].*end;
      for (long by = -most; by <= most; ++by) {
        if (by != 0) move(b, end, found + by - bursts[b].*end);
      }
    }
  }
}

/// By what a first answer leaves: its mean square, and how many of its samples tell anything new.
void LossSearch::weigh(std::size_t channel, std::span<const double> left, bool with_memory) {
  const double most = 5 * sigma_[channel];
  double sum = 0, both = 0, before = 0;
  for (const double r : left) {
    const double now = std::clamp(r, -most, most);
    sum += now * now;
    both += now * before;
    before = now;
  }
  const auto count = static_cast<double>(std::max<std::size_t>(left.size(), 1));
  const double memory = sum > 0 ? std::clamp(both / sum, 0.0, kMostMemory) : 0;
  sigma_[channel] = std::max({std::sqrt(sum / count), channels_[channel].noise, 1e-12});
  if (with_memory) new_[channel] = (1 - memory) / (1 + memory);
}

GoalLosses LossSearch::run() {
  new_.assign(channels_.size(), 1);
  choose_lateness();
  Bursts bursts;
  for (int pass = 0; pass < kPasses; ++pass) {
    bursts = without_idle(most_likely());
    if (pass + 1 == kPasses) break;
    fit_settings(bursts);
    const auto left = residuals(bursts);
    for (std::size_t c = 0; c < left.size(); ++c) weigh(c, left[c], pass > 0);
  }
  sharpen(bursts);
  // What is learnt along the way also hides what is wrong: a burst has to help without that too.
  learning_ = false;
  bursts = without_idle(bursts);
  learning_ = true;
  GoalLosses losses;
  losses.without = cost_of({});
  losses.gain = losses.without - cost_of(bursts) - kBurst * static_cast<double>(bursts.size());
  for (const Burst& burst : bursts) {
    losses.lost.push_back({clock_.time_s(burst.from * clock_.steps_per_law),
                           clock_.time_s(burst.until * clock_.steps_per_law)});
  }
  return losses;
}

}  // namespace

double GoalLosses::lost_s() const {
  double sum = 0;
  for (const sim::LostGoals& span : lost) sum += span.until_s - span.from_s;
  return sum;
}

GoalLosses find_losses(const PendulumSettings& settings, const PendulumInputs& inputs,
                       const sim::PendulumStart& start, std::span<const LossChannel> channels,
                       std::span<const LossDoubt> doubts, double longest_step_s) {
  if (inputs.time_s.size() < 20) return {};
  return LossSearch(settings, inputs, start, channels, doubts, longest_step_s).run();
}

}  // namespace hoof::tools
