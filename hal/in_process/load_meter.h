// How busy a wire is: over all time, and in the worst window of 1 ms and of 10 ms.
#pragma once

#include <algorithm>
#include <cstdint>

namespace hoof::hal {

/// Worst share of a fixed window in which the wire was occupied. Windows start at multiples of
/// their length (1 ms is the control tick, SYNC stands at its start), they do not slide.
class WindowLoad {
 public:
  explicit constexpr WindowLoad(std::int64_t window_ns) : window_ns_(window_ns) {}

  /// Intervals come in order and do not overlap.
  void add(std::int64_t start_ns, std::int64_t end_ns) {
    while (start_ns < end_ns) {
      if (start_ns >= window_end_ns_) {
        window_end_ns_ = (start_ns / window_ns_ + 1) * window_ns_;
        busy_ns_ = 0;
      }
      const std::int64_t piece_end_ns = std::min(end_ns, window_end_ns_);
      busy_ns_ += piece_end_ns - start_ns;
      worst_busy_ns_ = std::max(worst_busy_ns_, busy_ns_);
      start_ns = piece_end_ns;
    }
  }

  double worst_ratio() const {
    return static_cast<double>(worst_busy_ns_) / static_cast<double>(window_ns_);
  }

 private:
  std::int64_t window_ns_;
  std::int64_t window_end_ns_ = 0;
  std::int64_t busy_ns_ = 0;
  std::int64_t worst_busy_ns_ = 0;
};

class LoadMeter {
 public:
  /// The wire is taken from `start_ns` to `end_ns`; known as soon as the frame starts.
  void add(std::int64_t start_ns, std::int64_t end_ns) {
    total_busy_ns_ += end_ns - start_ns;
    last_end_ns_ = end_ns;
    per_1ms_.add(start_ns, end_ns);
    per_10ms_.add(start_ns, end_ns);
  }

  /// Occupied time up to `now_ns`, which lies in or after the last interval.
  std::int64_t busy_ns(std::int64_t now_ns) const {
    return total_busy_ns_ - std::max<std::int64_t>(0, last_end_ns_ - now_ns);
  }
  /// Mean since time 0; 0 at time 0.
  double mean_ratio(std::int64_t now_ns) const {
    return now_ns > 0 ? static_cast<double>(busy_ns(now_ns)) / static_cast<double>(now_ns) : 0.0;
  }
  double worst_1ms_ratio() const { return per_1ms_.worst_ratio(); }
  double worst_10ms_ratio() const { return per_10ms_.worst_ratio(); }

 private:
  std::int64_t total_busy_ns_ = 0;
  std::int64_t last_end_ns_ = 0;
  WindowLoad per_1ms_{1'000'000};
  WindowLoad per_10ms_{10'000'000};
};

}  // namespace hoof::hal
