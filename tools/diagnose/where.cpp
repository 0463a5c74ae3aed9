#include "tools/diagnose/where.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace hoof::tools {
namespace {

constexpr double kSmooth_s = 0.1;
/// Channels and recordings that show less than this share of the one that shows most are not named.
constexpr double kNamedShare = 0.35;
/// Fainter than this share of its top an effect is not said to be at work.
constexpr double kFaint = 0.05;
/// A region is named where the effect is this much denser in it than elsewhere.
constexpr double kDenser = 2.0;

}  // namespace

std::vector<double> smoothed(const std::vector<double>& time_s, const std::vector<double>& values,
                             double span_s) {
  std::vector<double> out(values.size());
  std::size_t from = 0, to = 0;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (to < values.size() && time_s[to] <= time_s[i] + 0.5 * span_s) sum += values[to++];
    while (time_s[from] < time_s[i] - 0.5 * span_s) sum -= values[from++];
    out[i] = sum / static_cast<double>(to - from);
  }
  return out;
}

namespace {

struct Change {
  const Group* group = nullptr;
  std::vector<double> squares;  // of the change, in units of the noise
  double mean = 0;
};

}  // namespace

double strong_bound(const std::vector<const std::vector<double>*>& levels) {
  std::vector<double> sorted;
  for (const auto* level : levels) sorted.insert(sorted.end(), level->begin(), level->end());
  if (sorted.empty()) return 0;
  std::sort(sorted.begin(), sorted.end());
  return std::max(sorted[sorted.size() / 2], kFaint * sorted[sorted.size() * 98 / 100]);
}

std::vector<std::pair<double, double>> spans_above(const std::vector<double>& time_s,
                                                   const std::vector<double>& level, double bound,
                                                   double close_s) {
  std::vector<std::pair<double, double>> spans;
  for (std::size_t i = 0; i < level.size(); ++i) {
    if (!(level[i] > bound)) continue;
    const double end = time_s[std::min(i + 1, time_s.size() - 1)];
    if (!spans.empty() && time_s[i] - spans.back().second <= close_s) {
      spans.back().second = end;
    } else {
      spans.push_back({time_s[i], end});
    }
  }
  return spans;
}

Place place_of(const Fitter& fitter, const Fit& with, const Fit& without) {
  const RigModel& model = fitter.model();
  std::vector<Change> changes;
  std::map<std::string, std::pair<double, double>> by_channel;  // sum, count
  std::vector<double> by_recording(model.recordings(), 0);
  for (int i = 0; i < model.recordings(); ++i) {
    const Prediction a = fitter.predict(with, i, Rollout::kCorrected);
    const Prediction b = fitter.predict(without, i, Rollout::kCorrected);
    for (const Group& group : fitter.groups()) {
      if (group.recording != i) continue;
      Change change{&group, {}, 0};
      for (std::size_t k = 0; k < a[group.channel].size(); ++k) {
        const double d = (a[group.channel][k] - b[group.channel][k]) / group.noise;
        change.squares.push_back(std::isfinite(d) ? d * d : 0);
        change.mean += change.squares.back();
      }
      change.mean /= std::max<double>(1, static_cast<double>(change.squares.size()));
      auto& channel = by_channel[model.channels(i)[group.channel]];
      channel.first += change.mean, channel.second += 1;
      changes.push_back(std::move(change));
    }
  }
  Place place;
  std::vector<std::pair<double, std::string>> channels;
  for (const auto& [name, sum] : by_channel) {
    channels.push_back({std::sqrt(sum.first / sum.second), name});
  }
  std::sort(channels.rbegin(), channels.rend());
  if (channels.empty()) return place;
  const std::string most = channels.front().second;
  for (const auto& [value, name] : channels) {
    if (value >= kNamedShare * channels.front().first) place.channels.push_back(name);
  }
  for (const Change& change : changes) {
    if (model.channels(change.group->recording)[change.group->channel] == most) {
      by_recording[change.group->recording] = std::sqrt(change.mean);
    }
  }
  const double top = *std::max_element(by_recording.begin(), by_recording.end());
  const Layout layout(model, with.effects);
  std::vector<std::pair<int, std::vector<double>>> levels;
  std::map<std::string, std::array<double, 4>> regions;  // inside: sum, count; outside: sum, count
  for (const Change& change : changes) {
    const int i = change.group->recording;
    if (model.channels(i)[change.group->channel] != most) continue;
    const Recording& recording = model.recording(i);
    if (by_recording[i] >= kNamedShare * top) place.recordings.push_back(recording.name);
    levels.push_back({i, model.strength(i, layout.setup(with.x), layout.active(with.x))});
    if (levels.back().second.empty()) {
      for (const double square : change.squares) levels.back().second.push_back(std::sqrt(square));
    }
    levels.back().second = smoothed(recording.time_s, levels.back().second, kSmooth_s);
    for (const RigModel::Condition& condition : model.conditions(i)) {
      auto& region = regions[condition.text];
      for (std::size_t k = 0; k < change.squares.size(); ++k) {
        const int at = condition.holds[k] ? 0 : 2;
        region[at] += change.squares[k];
        region[at + 1] += 1;
      }
    }
  }
  std::vector<const std::vector<double>*> all;
  for (const auto& [i, level] : levels) all.push_back(&level);
  const double bound = strong_bound(all);
  for (const auto& [i, level] : levels) {
    const Recording& recording = model.recording(i);
    for (const auto& [start, end] : spans_above(recording.time_s, level, bound, 0.5 * kSmooth_s)) {
      place.intervals.push_back({recording.name, start, end});
    }
  }
  place.condition = "always";
  double best = kDenser;
  for (const auto& [text, r] : regions) {
    if (r[1] < 20 || r[3] < 20) continue;
    const double lift = std::sqrt((r[0] / r[1]) / std::max(r[2] / r[3], 1e-12));
    const double share = r[0] / (r[0] + r[2]);
    if (share > 0.5 && lift > best) best = lift, place.condition = text;
  }
  return place;
}

}  // namespace hoof::tools
