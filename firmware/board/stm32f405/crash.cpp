// The fault handlers. None of them waits or repeats: they write the record and reset the board,
// which takes both CAN controllers off their buses, and the drives let go after 20 ms of silence.
// A fault in here locks the core up, and the watchdog resets it.
#include "firmware/board/stm32f405/crash.h"

#include <cstddef>
#include <span>

#include "firmware/app/crc32.h"
#include "firmware/board/stm32f405/memory.h"
#include "firmware/board/stm32f405/peripherals.h"

namespace hoof::firmware::stm32f405 {
namespace {

[[gnu::section(".crash"), gnu::used]] CrashRecord record;

/// What the core pushes on entry of an exception (ARM DDI 0403E, B1.5.6).
struct ExceptionFrame {
  std::uint32_t r0, r1, r2, r3, r12, lr, pc, psr;
};

std::uint32_t crc_of(const CrashRecord& crash) {
  const auto* words = reinterpret_cast<const std::uint32_t*>(&crash);
  return app::Crc32().add(std::span(words, offsetof(CrashRecord, crc) / 4)).value();
}

bool in_stack(std::uint32_t frame) {
  return frame >= kStackBottom && frame <= kStackTop - sizeof(ExceptionFrame) && frame % 4 == 0;
}

/// Starts over, keeping the count.
void open_record() {
  const std::uint32_t count = record.whole() ? record.count : 0;
  record = {};
  record.magic = CrashRecord::kMagic;
  record.count = count + 1;
}

[[noreturn]] void close_record_and_reset() {
  record.crc = crc_of(record);
  asm volatile("dsb" ::: "memory");
  scb_registers().AIRCR.write(scb::kReset);
  asm volatile("dsb" ::: "memory");
  for (;;) {  // the few cycles until the reset comes; should it not, the watchdog's does
  }
}

}  // namespace

bool CrashRecord::whole() const {
  return magic == kMagic && crc == crc_of(*this);
}

const CrashRecord& crash_record() {
  return record;
}

void panic(Panic reason) {
  asm volatile("cpsid i" ::: "memory");
  open_record();
  record.panic = static_cast<std::uint32_t>(reason);
  record.pc = reinterpret_cast<std::uint32_t>(__builtin_return_address(0));
  record.sp = reinterpret_cast<std::uint32_t>(__builtin_frame_address(0));
  close_record_and_reset();
}

void restart_on_request() {
  asm volatile("cpsid i" ::: "memory");
  open_record();
  --record.count;
  record.panic = static_cast<std::uint32_t>(Panic::kRestart);
  close_record_and_reset();
}

bool take_restart_request() {
  const bool requested =
      record.whole() && record.panic == static_cast<std::uint32_t>(Panic::kRestart);
  if (requested) {
    record.panic = 0;
    record.crc = crc_of(record);
  }
  return requested;
}

extern "C" {

[[noreturn, gnu::used]] void hoof_record_fault(std::uint32_t sp) {
  const ScbRegisters& scb = scb_registers();
  open_record();
  record.exception = scb.ICSR.read() & scb::kActiveException;
  record.cfsr = scb.CFSR.read();
  record.hfsr = scb.HFSR.read();
  record.mmfar = scb.MMFAR.read();
  record.bfar = scb.BFAR.read();
  record.sp = sp;
  if (in_stack(sp) && (record.cfsr & scb::kStackingFailed) == 0) {
    const auto* frame = reinterpret_cast<const ExceptionFrame*>(sp);
    record.pc = frame->pc;
    record.lr = frame->lr;
    record.psr = frame->psr;
  }
  close_record_and_reset();
}

/// On a stack of its own: the fault may be that the usual one is used up.
[[gnu::naked]] void hoof_fault() {
  asm volatile(
      "cpsid i\n\t"
      "mrs r0, msp\n\t"
      "ldr r1, =hoof_fault_stack_top\n\t"
      "msr msp, r1\n\t"
      "b hoof_record_fault\n\t"
      ".ltorg");
}

// What the compiler and the C++ library call where a program has gone wrong.
[[noreturn]] void abort() {
  panic(Panic::kAborted);
}
[[noreturn]] void __cxa_pure_virtual() {
  panic(Panic::kPureVirtualCall);
}
/// Destructors of static objects never run: main() does not end.
int __aeabi_atexit(void*, void (*)(void*), void*) {
  return 0;
}
void* __dso_handle = nullptr;
}

}  // namespace hoof::firmware::stm32f405
