#include "hil_bridge/duration_histogram.h"

#include <algorithm>
#include <cmath>

namespace hoof::bridge {

void DurationHistogram::add(std::int64_t duration_ns) {
  const std::int64_t ns = std::max<std::int64_t>(0, duration_ns);
  const std::int64_t bin = std::min((ns + 999) / 1000, kRange_us);
  ++bins_[static_cast<std::size_t>(bin)];
  ++count_;
  max_ns_ = std::max(max_ns_, ns);
}

std::int64_t DurationHistogram::percentile_ns(double share) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(share * double(count_)));
  std::uint64_t seen = 0;
  for (std::int64_t bin = 0; bin < kRange_us; ++bin) {
    seen += bins_[static_cast<std::size_t>(bin)];
    if (seen >= wanted && seen > 0) return bin * 1000;
  }
  return max_ns_;
}

std::vector<std::pair<std::int64_t, std::uint64_t>> DurationHistogram::octaves() const {
  std::vector<std::pair<std::int64_t, std::uint64_t>> result;
  std::int64_t first = 0;
  for (std::int64_t upper = 1; first <= kRange_us; upper *= 2) {
    std::uint64_t sum = 0;
    for (; first <= std::min(upper, kRange_us); ++first) sum += bins_[std::size_t(first)];
    // The last bin holds all that is longer than the range: its end is the longest of them.
    const bool last = upper > kRange_us;
    const std::int64_t end_us = last ? std::max(upper, (max_ns_ + 999) / 1000) : upper;
    if (sum > 0 || !result.empty()) result.emplace_back(end_us, sum);
  }
  while (!result.empty() && result.back().second == 0) result.pop_back();
  return result;
}

}  // namespace hoof::bridge
