#include "tools/conceal/intervals.h"

#include <algorithm>

namespace hoof::tools::conceal {
namespace {

constexpr double kWindow_s = 0.1;

std::vector<double> smoothed(const std::vector<double>& t, const std::vector<double>& x) {
  std::vector<double> out(x.size());
  std::size_t from = 0, to = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (; to < x.size() && t[to] <= t[i] + 0.5 * kWindow_s; ++to) sum += x[to];
    for (; t[from] < t[i] - 0.5 * kWindow_s; ++from) sum -= x[from];
    out[i] = std::max(0.0, sum / double(to - from));
  }
  return out;
}

void add_intervals(const StrengthSeries& s, double bound, std::vector<TimeInterval>& out) {
  bool open = false;
  for (std::size_t i = 0; i < s.strength.size(); ++i) {
    if (s.strength[i] <= bound) {
      open = false;
      continue;
    }
    const bool joins = !out.empty() && out.back().recording == s.recording &&
                       s.times_s[i] - out.back().end_s < kWindow_s;
    if (!open && !joins) out.push_back({s.recording, s.times_s[i], s.times_s[i]});
    out.back().end_s = s.times_s[i];
    open = true;
  }
}

}  // namespace

std::vector<TimeInterval> strong_intervals(std::vector<StrengthSeries> series) {
  std::vector<double> all;
  for (StrengthSeries& s : series) {
    s.strength = smoothed(s.times_s, s.strength);
    all.insert(all.end(), s.strength.begin(), s.strength.end());
  }
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  const auto quantile = [&all](double q) { return all[std::size_t(q * double(all.size() - 1))]; };
  const double most = quantile(0.98), median = quantile(0.5);
  if (most <= 0.0 || median > 0.8 * most) return {};
  std::vector<TimeInterval> out;
  for (const StrengthSeries& s : series) add_intervals(s, std::max(median, 0.02 * most), out);
  std::erase_if(out, [](const TimeInterval& i) { return i.end_s - i.start_s < 0.02; });
  return out;
}

nlohmann::ordered_json to_json(const std::vector<TimeInterval>& intervals) {
  auto list = nlohmann::ordered_json::array();
  for (const TimeInterval& i : intervals) {
    list.push_back({{"recording", i.recording}, {"start", i.start_s}, {"end", i.end_s}});
  }
  return list;
}

}  // namespace hoof::tools::conceal
