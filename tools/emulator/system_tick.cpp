#include "tools/emulator/system_tick.h"

namespace hoof::tools::emulator {
namespace {

enum Offset { kControl = 0x0, kReload = 0x4, kCurrent = 0x8, kCalibration = 0xC };
constexpr std::uint32_t kInterrupt = 1u << 1;
constexpr std::uint32_t kCoreClock = 1u << 2;

}  // namespace

void SystemTick::reset() {
  control_ = 0;
  reload_ = 0;
  passed_zero_ = false;
  next_ = kNever;
  core_MHz_ = 16;
}

/// Zero in this cycle, the reload value in the next, zero again a period later.
void SystemTick::start() {
  next_ = now() + period();
}

void SystemTick::set_core_MHz(std::uint32_t megahertz) {
  core_MHz_ = megahertz;
  if (running()) start();
}

void SystemTick::set_stuck(bool stuck) {
  if (stuck == stuck_) return;
  if (stuck) {
    advance();
    stuck_at_ = time_.now;
  } else {
    next_ += running() ? time_.now - stuck_at_ : 0;
  }
  stuck_ = stuck;
}

void SystemTick::advance() {
  while (running() && next_ <= now()) {
    next_ += period();
    passed_zero_ = true;
    if ((control_ & kInterrupt) != 0) nvic_.pend(exception::kSysTick);
  }
}

std::uint32_t SystemTick::read(std::uint32_t offset) {
  switch (offset) {
    case kControl: {
      const std::uint32_t value = control_ | (passed_zero_ ? 1u << 16 : 0);
      passed_zero_ = false;
      return value;
    }
    case kReload:
      return reload_;
    case kCurrent: {
      if (!running()) return 0;
      const Cycles left = (next_ - now()) * core_MHz_ / 168;
      return left > Cycles(reload_) ? 0 : std::uint32_t(left);
    }
    default:
      no_such_register(offset);
  }
}

void SystemTick::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kControl:
      if ((value & kCoreClock) == 0) throw EmulatorError("SysTick on the divided clock: no model");
      if ((value & 1) != 0 && !running()) {
        control_ = value & 7;
        start();
      }
      control_ = value & 7;
      return;
    case kReload:
      reload_ = value & 0xFF'FFFF;
      return;
    case kCurrent:
      passed_zero_ = false;
      start();
      return;
    default:
      no_such_register(offset);
  }
}

}  // namespace hoof::tools::emulator
