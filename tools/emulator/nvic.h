// Which exception runs next: pending, enabled, masked, active; and the registers of it.
//
// Source: ARM DDI 0403E (ARMv7-M), B1.5 (exceptions), B3.4 (NVIC).
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <vector>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

namespace exception {
inline constexpr int kReset = 1;
inline constexpr int kNmi = 2;
inline constexpr int kHardFault = 3;
inline constexpr int kMemoryFault = 4;
inline constexpr int kBusFault = 5;
inline constexpr int kUsageFault = 6;
inline constexpr int kSvCall = 11;
inline constexpr int kPendSv = 14;
inline constexpr int kSysTick = 15;
inline constexpr int kFirstInterrupt = 16;
}  // namespace exception

/// PRIMASK, FAULTMASK and BASEPRI as the core has them.
struct Masks {
  bool primask = false;
  bool faultmask = false;
  std::uint8_t basepri = 0;
};

class Nvic final : public Peripheral {
 public:
  static constexpr int kInterrupts = 82;  // of the STM32F405
  static constexpr int kExceptions = exception::kFirstInterrupt + kInterrupts;
  static constexpr std::uint8_t kPriorityBits = 0xF0;  // four of eight are there

  // Registers from 0xE000E100 on.
  const char* name() const override { return "NVIC"; }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  void pend(int exception) { pending_.set(std::size_t(exception)); }
  void unpend(int exception) { pending_.reset(std::size_t(exception)); }
  bool pending(int exception) const { return pending_.test(std::size_t(exception)); }
  /// False where nothing is due, whatever the masks are.
  bool some_pending() const { return pending_.any(); }
  /// An interrupt's request line. High it stays pending until it is served; still high at the end
  /// of its handler it is pending again.
  void set_line(int exception, bool high);

  /// The exception to be taken now; 0 where there is none.
  int due(const Masks& masks) const;
  /// Whether WFI ends: as due(), but PRIMASK does not keep the core asleep (B1.5.19).
  bool wakes(const Masks& masks) const;

  void activate(int exception);
  void deactivate(int exception);
  /// The exception that runs; 0 in thread mode.
  int active() const { return active_.empty() ? 0 : active_.back(); }
  bool thread_next() const { return active_.size() == 1; }

  /// -3 to 255, small wins.
  int priority(int exception) const;
  void set_priority(int exception, std::uint8_t value) {
    state_[std::size_t(exception)].priority = value & kPriorityBits;
  }
  void set_group_bits(std::uint32_t prigroup) { prigroup_ = prigroup; }
  /// For the faults, whose switches are in SHCSR.
  void enable(int exception, bool on) { state_[std::size_t(exception)].enabled = on; }
  bool enabled(int exception) const { return state_[std::size_t(exception)].enabled; }
  /// The lowest-numbered pending one of highest priority, as ICSR.VECTPENDING shows it.
  int highest_pending() const;

  /// The priority at which the core runs, masks included; 256 in thread mode.
  int running_priority(const Masks& masks) const;

 private:
  struct State {
    bool enabled = false;
    bool line = false;
    bool active = false;
    std::uint8_t priority = 0;
  };

  int group(int priority) const;
  template <typename Act>
  void for_each_bit(std::uint32_t word, std::uint32_t value, Act&& act);

  std::array<State, kExceptions> state_{};
  std::bitset<kExceptions> pending_;
  std::vector<int> active_;
  std::uint32_t prigroup_ = 0;
};

}  // namespace hoof::tools::emulator
