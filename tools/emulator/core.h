// Exceptions of Armv7-M around the processor: entry, return, nesting, tail-chaining, faults, sleep.
//
// Source: ARM DDI 0403E, B1.5.
#pragma once

#include "tools/emulator/cpu.h"
#include "tools/emulator/nvic.h"
#include "tools/emulator/system_control.h"

namespace hoof::tools::emulator {

class Core {
 public:
  enum class Stop {
    kAsleep,
    kResetRequested,
    kLockedUp,  // a fault in a fault handler: only a reset helps
    kStuck,     // never sleeps
  };
  struct Counts {
    std::uint64_t exceptions = 0;    // entered
    std::uint64_t tail_chained = 0;  // of these, without unstacking between
  };

  Core(Cpu& cpu, Nvic& nvic, SystemControl& control) : cpu_(cpu), nvic_(nvic), control_(control) {}

  /// As after a reset: stack pointer and start from the vectors at `vectors`.
  void reset(std::uint32_t vectors);
  /// Whether an interrupt ends the sleep.
  bool wakes() const { return nvic_.some_pending() && nvic_.wakes(masks()); }
  /// Until it sleeps and nothing is due.
  Stop run();

  const Counts& counts() const { return counts_; }
  /// The last fault that was raised, for messages.
  const Cpu::Fault& last_fault() const { return last_fault_; }

 private:
  Masks masks() const;
  /// The exception to be taken now; 0 where there is none.
  int due() const { return nvic_.some_pending() ? nvic_.due(masks()) : 0; }
  void enter(int exception);
  void tail_chain(int exception, std::uint32_t exception_return);
  void go_to_handler(int exception, CoreRegisters registers);
  bool push_frame(CoreRegisters& registers);
  void return_from_exception();
  bool take_fault();

  Cpu& cpu_;
  Nvic& nvic_;
  SystemControl& control_;
  Counts counts_;
  Cpu::Fault last_fault_;
  bool locked_up_ = false;
};

}  // namespace hoof::tools::emulator
