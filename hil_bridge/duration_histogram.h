// Counts of durations by the microsecond, for percentiles of latency and jitter.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace hoof::bridge {

class DurationHistogram {
 public:
  /// Negative durations count as 0. No memory is taken: it is called in real time.
  void add(std::int64_t duration_ns);

  std::uint64_t count() const { return count_; }
  std::int64_t max_ns() const { return max_ns_; }

  /// The shortest duration, rounded up to whole microseconds, that at least this share of all does
  /// not exceed; beyond kRange_us the longest one. 0 where nothing was counted.
  /// @param share above 0, at most 1
  std::int64_t percentile_ns(double share) const;

  /// Counts by powers of two: (upper end in microseconds, count); empty ends left out.
  std::vector<std::pair<std::int64_t, std::uint64_t>> octaves() const;

  static constexpr std::int64_t kRange_us = 20'000;

 private:
  std::array<std::uint32_t, kRange_us + 1> bins_{};  // bin i: above i - 1 to i us; the last: longer
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace hoof::bridge
