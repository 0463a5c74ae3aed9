#include "hil_bridge/deadline_schedule.h"

#include <algorithm>
#include <cstdlib>

namespace hoof::bridge {

void DeadlineSchedule::work_done(std::int64_t now_ns) {
  if (now_ns > deadline_ns_) ++overruns_;
}

std::uint32_t DeadlineSchedule::woke(std::int64_t now_ns) {
  const std::int64_t late_ns = std::max<std::int64_t>(0, now_ns - deadline_ns_);
  const std::int64_t passed = late_ns / period_ns_;
  const std::int64_t due = 1 + passed;
  latency_.add(late_ns);
  if (woken_) jitter_.add(std::abs(now_ns - last_wake_ns_ - period_ns_ * due));
  woken_ = true;
  last_wake_ns_ = now_ns;
  deadline_ns_ += due * period_ns_;
  ticks_ += static_cast<std::uint64_t>(due);
  missed_ += static_cast<std::uint64_t>(passed);
  return static_cast<std::uint32_t>(due);
}

}  // namespace hoof::bridge
