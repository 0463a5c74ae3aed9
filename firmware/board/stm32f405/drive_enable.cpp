#include "firmware/board/stm32f405/drive_enable.h"

namespace hoof::firmware::stm32f405 {
namespace {

constexpr std::uint32_t kCount_Hz = 1'000'000;
constexpr std::uint32_t kPeriod = kCount_Hz / DriveEnable::kWave_Hz;
static_assert(kPeriod * DriveEnable::kWave_Hz == kCount_Hz);

}  // namespace

void DriveEnable::start(std::uint32_t timer_Hz) {
  timer_.PSC.write(timer_Hz / kCount_Hz - 1);
  timer_.ARR.write(kPeriod - 1);
  timer_.CCR[0].write(kPeriod / 2);
  timer_.CCMR[0].write(timer::kWave);
  timer_.CCER.write(timer::kChannel1);
  timer_.EGR.write(timer::kUpdate);
  // In one write: the lock takes all of it (RM0090, 17.4.18).
  timer_.BDTR.write(timer::kBreakOn | timer::kIdleDriven | timer::kLockAll);
  timer_.SR.write(0);  // where the loop is open the break's flag comes back
  timer_.DIER.write(timer::kBreak);
  timer_.CR1.write(timer::kReloadBuffered | timer::kCounts);
}

void DriveEnable::allow(bool allowed) {
  if (allowed && on_) return;  // after a break the loop sees its flag, and stops first
  if (allowed) {
    if (broken()) return;
    timer_.BDTR.set(timer::kMainOutput);
    on_ = true;
    return;
  }
  on_ = false;
  timer_.BDTR.clear(timer::kMainOutput);
  if (!broken()) return;
  timer_.SR.write(~timer::kBreak);  // has no effect while the loop is open
  if (!broken()) timer_.DIER.set(timer::kBreak);
}

}  // namespace hoof::firmware::stm32f405
