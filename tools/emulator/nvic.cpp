#include "tools/emulator/nvic.h"

#include <algorithm>

namespace hoof::tools::emulator {
namespace {

constexpr int kThreadPriority = 256;

enum Bank {
  kSetEnable = 0x000,
  kClearEnable = 0x080,
  kSetPending = 0x100,
  kClearPending = 0x180,
  kActive = 0x200,
  kPriorities = 0x300
};

}  // namespace

void Nvic::reset() {
  state_ = {};
  pending_.reset();
  active_.clear();
  prigroup_ = 0;
  for (const int always : {exception::kNmi, exception::kHardFault, exception::kSvCall,
                           exception::kPendSv, exception::kSysTick}) {
    enable(always, true);
  }
}

void Nvic::set_line(int exception, bool high) {
  State& s = state_[std::size_t(exception)];
  if (high && !s.line) pend(exception);  // also a new edge while it is served
  s.line = high;
}

int Nvic::priority(int exception) const {
  switch (exception) {
    case exception::kReset:
      return -3;
    case exception::kNmi:
      return -2;
    case exception::kHardFault:
      return -1;
    default:
      return state_[std::size_t(exception)].priority;
  }
}

/// The part of a priority that decides whether one exception interrupts another (B1.5.4).
int Nvic::group(int priority) const {
  if (priority < 0) return priority;
  return priority & ~((2 << prigroup_) - 1);
}

int Nvic::running_priority(const Masks& masks) const {
  int running = kThreadPriority;
  for (const int each : active_) running = std::min(running, group(priority(each)));
  if (masks.basepri != 0) running = std::min(running, group(masks.basepri));
  if (masks.primask) running = std::min(running, 0);
  if (masks.faultmask) running = std::min(running, -1);
  return running;
}

int Nvic::highest_pending() const {
  if (!some_pending()) return 0;
  int best = 0;
  for (int e = exception::kNmi; e < kExceptions; ++e) {
    if (!pending(e) || !enabled(e)) continue;
    if (best == 0 || priority(e) < priority(best)) best = e;
  }
  return best;
}

int Nvic::due(const Masks& masks) const {
  const int best = highest_pending();
  return best != 0 && group(priority(best)) < running_priority(masks) ? best : 0;
}

bool Nvic::wakes(const Masks& masks) const {
  Masks without = masks;
  without.primask = false;
  return due(without) != 0;
}

void Nvic::activate(int exception) {
  unpend(exception);
  state_[std::size_t(exception)].active = true;
  active_.push_back(exception);
}

void Nvic::deactivate(int exception) {
  State& s = state_[std::size_t(exception)];
  s.active = false;
  active_.erase(std::remove(active_.begin(), active_.end(), exception), active_.end());
  if (s.line) pend(exception);
}

template <typename Act>
void Nvic::for_each_bit(std::uint32_t word, std::uint32_t value, Act&& act) {
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    const std::uint32_t interrupt = 32 * word + bit;
    if ((value >> bit & 1) == 0) continue;
    if (interrupt >= kInterrupts) {
      throw EmulatorError("NVIC: interrupt " + std::to_string(interrupt) + " is not there; 0 to " +
                          std::to_string(kInterrupts - 1) + " are");
    }
    act(int(exception::kFirstInterrupt + interrupt));
  }
}

std::uint32_t Nvic::read(std::uint32_t offset) {
  const std::uint32_t bank = offset & ~0x7Fu;
  std::uint32_t value = 0;
  if (offset >= kPriorities && offset < kPriorities + kInterrupts + 2) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t interrupt = offset - kPriorities + i;
      if (interrupt < kInterrupts) {
        value |= std::uint32_t{state_[exception::kFirstInterrupt + interrupt].priority} << (8 * i);
      }
    }
    return value;
  }
  if (bank > kActive || (offset & 0x7F) > 8) no_such_register(offset);
  for (std::uint32_t bit = 0; bit < 32; ++bit) {
    const std::uint32_t interrupt = 8 * (offset & 0x7F) + bit;
    if (interrupt >= kInterrupts) break;
    const State& s = state_[exception::kFirstInterrupt + interrupt];
    const bool set = bank <= kClearEnable    ? s.enabled
                     : bank <= kClearPending ? pending(int(exception::kFirstInterrupt + interrupt))
                                             : s.active;
    value |= std::uint32_t{set} << bit;
  }
  return value;
}

void Nvic::write(std::uint32_t offset, std::uint32_t value) {
  if (offset >= kPriorities && offset < kPriorities + kInterrupts + 2) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t interrupt = offset - kPriorities + i;
      if (interrupt < kInterrupts) {
        set_priority(int(exception::kFirstInterrupt + interrupt), std::uint8_t(value >> (8 * i)));
      }
    }
    return;
  }
  const std::uint32_t word = (offset & 0x7F) / 4;
  if (word > 2) no_such_register(offset);
  switch (offset & ~0x7Fu) {
    case kSetEnable:
      return for_each_bit(word, value, [this](int e) { enable(e, true); });
    case kClearEnable:
      return for_each_bit(word, value, [this](int e) { enable(e, false); });
    case kSetPending:
      return for_each_bit(word, value, [this](int e) { pend(e); });
    case kClearPending:
      return for_each_bit(word, value, [this](int e) {
        const State& s = state_[std::size_t(e)];
        pending_.set(std::size_t(e), s.line && !s.active);
      });
    default:
      no_such_register(offset);
  }
}

}  // namespace hoof::tools::emulator
