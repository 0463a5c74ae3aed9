// When the ticks of a real-time run are due, and how well they were kept. Knows no clock: it is
// told the time, so that a test can tell it any.
#pragma once

#include <cstdint>

#include "hil_bridge/duration_histogram.h"

namespace hoof::bridge {

/// Deadlines lie on a grid from the start on and never drift: one that was missed is left out, the
/// next one is where it always was.
class DeadlineSchedule {
 public:
  /// @param period_ns above 0
  DeadlineSchedule(std::int64_t start_ns, std::int64_t period_ns)
      : period_ns_(period_ns), deadline_ns_(start_ns + period_ns), last_wake_ns_(start_ns) {}

  std::int64_t deadline_ns() const { return deadline_ns_; }

  /// The work of the tick ended; after its deadline, that is an overrun.
  void work_done(std::int64_t now_ns);

  /// Awake for the deadline.
  /// @return ticks that have become due: 1, and one more for each deadline that passed unseen
  std::uint32_t woke(std::int64_t now_ns);

  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t overruns() const { return overruns_; }
  std::uint64_t missed() const { return missed_; }  // ticks that were left out
  /// From the deadline until awake.
  const DurationHistogram& latency() const { return latency_; }
  /// How far two wakes lie from a whole number of periods apart, either way.
  const DurationHistogram& jitter() const { return jitter_; }

 private:
  std::int64_t period_ns_;
  std::int64_t deadline_ns_;
  std::int64_t last_wake_ns_;
  std::uint64_t ticks_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t missed_ = 0;
  bool woken_ = false;
  DurationHistogram latency_;
  DurationHistogram jitter_;
};

}  // namespace hoof::bridge
