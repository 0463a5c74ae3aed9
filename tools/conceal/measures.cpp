#include "tools/conceal/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace hoof::tools::conceal {
namespace {

constexpr double kClear_dB = 20.0;

using Chooser = std::function<bool(const TruthCase&)>;

bool clear_one(const TruthCase& c) {
  return c.kind == "one" && c.effort_snr_db >= kClear_dB;
}

Measure share(const std::string& name, int good, int count, double floor, double aim) {
  Measure m{name, count > 0 ? double(good) / count : 0.0, count, clopper_pearson(good, count)};
  m.floor_low = floor;
  m.aim_low = aim;
  return m;
}

Measure mean(const std::string& name, const std::vector<double>& values, double floor, double aim) {
  Measure m{name, values.empty() ? 0.0 : mean_of(values), int(values.size()), mean_bounds(values)};
  m.floor_low = floor;
  m.aim_low = aim;
  return m;
}

bool found(const GradedCase& c, const std::string& effect) {
  if (!c.answer || c.answer->verdict != "missing_physics") return false;
  const std::size_t looked_at = std::min(c.answer->effects.size(), c.truth.effects.size());
  for (std::size_t i = 0; i < looked_at; ++i) {
    if (c.answer->effects[i].name == effect) return true;
  }
  return false;
}

std::vector<TimeInterval> within(const std::vector<TimeInterval>& all,
                                 const std::set<std::string>& recordings) {
  std::vector<TimeInterval> kept;
  for (const TimeInterval& i : all) {
    if (recordings.contains(i.recording)) kept.push_back(i);
  }
  return kept;
}

/// Of the error that the nominal model leaves on held-out runs in the clearest channel, the share
/// that is removed, where the model that knows the truth removes all but its own.
std::optional<double> error_removed(const GradedCase& c) {
  const std::string key = c.truth.main_channel() + "_rmse";
  if (!c.truth.foreseeable || !c.truth.holdout_rmse.contains(key)) return std::nullopt;
  if (!c.answer || !c.answer->holdout_before.contains(key)) return 0.0;
  const double truth = c.truth.holdout_rmse.at(key), before = c.answer->holdout_before.at(key);
  if (before < 1.1 * truth) return std::nullopt;  // little to remove in these runs
  const auto after = c.answer->holdout_after.find(key);
  if (after == c.answer->holdout_after.end()) return 0.0;
  return std::clamp((before - after->second) / (before - truth), -1.0, 1.0);
}

/// Top entry of `probabilities` and whether it is so. A pair counts as found by either member.
void add_said(const GradedCase& c, std::vector<std::pair<double, bool>>& said) {
  if (!c.answer || c.answer->probabilities.empty() || c.truth.kind == "not_decidable") return;
  const auto& p = c.answer->probabilities;
  const auto top =
      std::max_element(p.begin(), p.end(), [](auto& a, auto& b) { return a.second < b.second; });
  bool so = top->first == label(c.truth);
  if (c.truth.kind == "pair") {
    const std::vector<std::string> parts = pick_named(top->first).names;
    so = !parts.empty() && std::all_of(parts.begin(), parts.end(), [&c](const std::string& name) {
      return std::any_of(c.truth.effects.begin(), c.truth.effects.end(),
                         [&name](const HiddenEffect& e) { return e.name == name; });
    });
  }
  said.push_back({std::clamp(top->second, 0.0, 1.0), so});
}

}  // namespace

std::vector<Measure> verdict_measures(const std::vector<TruthCase>& cases,
                                      const std::vector<std::optional<Pick>>& picks) {
  const auto count_right = [&](const std::string& name, const Chooser& chosen, double floor,
                               double aim) {
    int good = 0, count = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (!chosen(cases[i])) continue;
      ++count;
      if (picks[i] && right(cases[i], *picks[i])) ++good;
    }
    return share(name, good, count, floor, aim);
  };
  const auto kind = [](const char* word) {
    return [word](const TruthCase& c) { return c.kind == word; };
  };
  Measure alarms = count_right(
      "false alarms, nothing hidden", [](const TruthCase& c) { return c.nothing_hidden(); }, 0, 0);
  alarms.value = alarms.count > 0 ? 1.0 - alarms.value : 0.0;
  alarms.bounds = {1.0 - alarms.bounds.high, 1.0 - alarms.bounds.low};
  alarms.floor_high = 0.05;
  alarms.aim_high = 0.02;
  return {alarms,
          count_right(
              "right name, one effect, >= 20 dB",
              [](const TruthCase& c) { return clear_one(c) && !c.masked; }, 0.85, 0.95),
          count_right(
              "  the same, masked by the loop",
              [](const TruthCase& c) { return clear_one(c) && c.masked; }, 0.70, 0.85),
          count_right("both named, pairs", kind("pair"), 0.50, 0.70),
          count_right("unknown_physics where it is so", kind("unknown"), 0.60, 0.80),
          count_right("not_separable where it is so", kind("not_decidable"), 0.70, 0.90)};
}

bool holds_truth(const EffectParameter& truth, const AnsweredParameter& answered) {
  std::vector<double> readings = truth.other_readings;
  readings.push_back(truth.value);
  // Seven digits of a file, so that a number given exactly counts.
  const double slack = 1e-6 * std::max(1.0, std::abs(truth.value));
  return std::any_of(readings.begin(), readings.end(), [&](double v) {
    if (truth.period > 0.0) {
      v += truth.period * std::ceil((answered.low - slack - v) / truth.period);
    }
    return v >= answered.low - slack && v <= answered.high + slack;
  });
}

double overlap(const std::vector<TimeInterval>& a, const std::vector<TimeInterval>& b) {
  // Each list's intervals may overlap among themselves, so the time line is cut at all ends.
  double both = 0.0, either = 0.0;
  std::map<std::string, std::set<double>> cuts;
  for (const auto* list : {&a, &b}) {
    for (const TimeInterval& i : *list) cuts[i.recording].insert({i.start_s, i.end_s});
  }
  const auto covers = [](const std::vector<TimeInterval>& list, const std::string& recording,
                         double t_s) {
    return std::any_of(list.begin(), list.end(), [&](const TimeInterval& i) {
      return i.recording == recording && t_s > i.start_s && t_s < i.end_s;
    });
  };
  for (const auto& [recording, times] : cuts) {
    for (auto at = times.begin(); std::next(at) != times.end(); ++at) {
      const double middle = 0.5 * (*at + *std::next(at)), span = *std::next(at) - *at;
      const bool in_a = covers(a, recording, middle), in_b = covers(b, recording, middle);
      if (in_a && in_b) both += span;
      if (in_a || in_b) either += span;
    }
  }
  return either > 0.0 ? both / either : 0.0;
}

double calibration_error(const std::vector<std::pair<double, bool>>& said_and_right) {
  constexpr int kBins = 10;
  double gap[kBins] = {};
  for (const auto& [said, so] : said_and_right) {
    gap[std::min(kBins - 1, int(said * kBins))] += said - (so ? 1.0 : 0.0);
  }
  double sum = 0.0;
  for (const double g : gap) sum += std::abs(g);
  return said_and_right.empty() ? 0.0 : sum / double(said_and_right.size());
}

std::vector<Measure> answer_measures(const std::vector<GradedCase>& cases) {
  int channel_good = 0, channel_count = 0, held = 0, asked = 0;
  std::vector<double> overlaps, removed;
  std::vector<std::pair<double, bool>> said;
  for (const GradedCase& c : cases) {
    add_said(c, said);
    if (c.truth.kind != "one" && c.truth.kind != "pair") continue;
    ++channel_count;
    const std::vector<std::string> clear = c.truth.clear_channels();
    const bool named = c.answer && !c.answer->channels.empty();
    if (named && std::count(clear.begin(), clear.end(), c.answer->channels[0]) > 0) ++channel_good;
    if (!c.truth.intervals.empty()) {
      const std::set<std::string> recordings(c.truth.fit_recordings.begin(),
                                             c.truth.fit_recordings.end());
      overlaps.push_back(
          c.answer ? overlap(within(c.answer->intervals, recordings), c.truth.intervals) : 0.0);
    }
    if (const auto share_removed = error_removed(c)) removed.push_back(*share_removed);
    for (const HiddenEffect& effect : c.truth.effects) {
      if (!found(c, effect.name)) continue;
      const auto answered = std::find_if(c.answer->effects.begin(), c.answer->effects.end(),
                                         [&](const auto& e) { return e.name == effect.name; });
      for (const EffectParameter& p : effect.parameters) {
        ++asked;
        const auto at = answered->parameters.find(p.name);
        if (at != answered->parameters.end() && holds_truth(p, at->second)) ++held;
      }
    }
  }
  Measure intervals = share("95 % intervals that hold the truth", held, asked, 0.90, 0.93);
  intervals.floor_high = 0.98;
  intervals.aim_high = 0.97;
  Measure overlapping = mean("overlap of intervals (IoU)", overlaps, 0.5, 0.7);
  overlapping.is_share = false;
  Measure calibration{"calibration error",
                      calibration_error(said),
                      int(said.size()),
                      {0.0, 1.0},
                      0.0,
                      0.10,
                      0.0,
                      0.05,
                      false};
  return {share("right channel", channel_good, channel_count, 0.90, 0.97), overlapping, intervals,
          mean("held-out error removed", removed, 0.70, 0.90), calibration};
}

}  // namespace hoof::tools::conceal
