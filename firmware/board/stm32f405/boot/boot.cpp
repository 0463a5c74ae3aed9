// The boot loader: starts the newer of two images that is signed and has not failed. Runs once
// after each reset, with interrupts masked, waits for nothing without bound, and leaves the part as
// a reset leaves it, but for the watchdog, which runs: an image that hangs at once is ended, too.
#include "firmware/board/stm32f405/clock_tree.h"
#include "firmware/board/stm32f405/flash_memory.h"
#include "firmware/board/stm32f405/memory.h"
#include "firmware/board/stm32f405/peripherals.h"
#include "firmware/update/boot_choice.h"

namespace hoof::firmware::stm32f405 {
namespace {

/// Written into the image when it is packed.
extern "C" const update::PublicKey hoof_public_key;

void feed_watchdog() {
  Watchdog(iwdg_registers()).feed();
}

/// Main stack pointer and entry of an image, as a reset would take them (ARM DDI 0403E, B1.5.5).
[[noreturn]] void start_image(std::size_t slot) {
  const std::uintptr_t vectors =
      kImages + slot * kImageBytes + update::kHeaderWords * hal::Nonvolatile::kWordBytes;
  scb_registers().VTOR.write(vectors);
  asm volatile(
      "dsb\n\tisb\n\t"
      "ldr r1, [%0]\n\t"
      "ldr r2, [%0, #4]\n\t"
      "msr msp, r1\n\t"
      "bx r2\n\t" ::"r"(vectors)
      : "r1", "r2", "memory");
  __builtin_unreachable();
}

}  // namespace

extern "C" {

[[noreturn, gnu::used]] void hoof_boot() {
  Watchdog watchdog(iwdg_registers());
  watchdog.start(Watchdog::Time::kStart);
  start_internal_clock(rcc_registers(), pwr_registers(), flash_registers());
  SystemClock no_clock(systick_registers(), scb_registers());  // nothing is erased here
  FlashMemory images(flash_registers(), reinterpret_cast<hal::Register*>(kImages), watchdog,
                     no_clock, FlashMemory::kImages);
  const auto slot =
      update::BootChoice(images, hoof_public_key, update::kFootBoard, feed_watchdog).choose();
  stop_internal_clock(rcc_registers());
  feed_watchdog();
  if (slot) start_image(*slot);
  // Nothing to start: a programmer has to come. The watchdog resets, and all is looked at anew.
  for (;;) asm volatile("wfi");
}

/// Of the boot loader itself: from the top, with the watchdog behind it.
[[noreturn, gnu::used]] void hoof_boot_fault() {
  scb_registers().AIRCR.write(scb::kReset);
  for (;;) {
  }
}

/// Floating-point registers are the compiler's to use.
[[gnu::naked, gnu::used]] void hoof_boot_reset() {
  asm volatile(
      "cpsid i\n\t"
      "ldr r0, =0xE000ED88\n\t"
      "ldr r1, [r0]\n\t"
      "orr r1, r1, #0xF00000\n\t"
      "str r1, [r0]\n\t"
      "dsb\n\tisb\n\t"
      "b hoof_boot\n\t"
      ".ltorg");
}

// What the compiler and the C++ library call where a program has gone wrong.
[[noreturn]] void abort() {
  hoof_boot_fault();
}
[[noreturn]] void __cxa_pure_virtual() {
  hoof_boot_fault();
}
}

namespace {

using Handler = void (*)();

/// Interrupts are masked: of the vectors those of faults are enough.
struct BootVectors {
  const void* stack;
  std::array<Handler, 15> exceptions;
};

constexpr BootVectors make_vectors() {
  BootVectors vectors{&hoof_stack_top, {}};
  vectors.exceptions.fill(hoof_boot_fault);
  vectors.exceptions[0] = hoof_boot_reset;
  return vectors;
}

[[gnu::section(".boot_vectors"), gnu::used]] constexpr BootVectors kVectorTable = make_vectors();

}  // namespace
}  // namespace hoof::firmware::stm32f405
