#include "firmware/board/stm32f405/system_clock.h"

namespace hoof::firmware::stm32f405 {
namespace {

constexpr std::uint32_t kMillisecond_ns = 1'000'000;

}  // namespace

/// The counter may run through zero at any moment in here. Either the interrupt then changes the
/// milliseconds, and everything is read again; or, where it cannot run, the tick stays pending, and
/// the second reading of the counter is certainly from after it.
std::int64_t SystemClock::now_ns() const {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t before = 0;
  std::uint32_t after = 0;
  bool pending = false;
  do {
    high = high_;
    low = low_;
    before = systick_.CVR.read();
    pending = scb_.ICSR.has(scb::kPendingTick);
    after = systick_.CVR.read();
  } while (low != low_ || high != high_);
  const std::uint32_t left = pending ? after : before;
  // The tick is raised on reaching zero: zero is the first cycle of a millisecond, not the last.
  const std::uint32_t cycles = left == 0 ? 0 : reload_ + 1 - left;
  const std::uint32_t part_ns = cycles * 1'000 / cycles_per_us_ + (pending ? kMillisecond_ns : 0);
  // One long multiplication; of the upper word only what stays below 2^64.
  const std::uint64_t whole_ns =
      std::uint64_t{low} * kMillisecond_ns + (std::uint64_t{high * kMillisecond_ns} << 32);
  return static_cast<std::int64_t>(whole_ns + part_ns);
}

}  // namespace hoof::firmware::stm32f405
