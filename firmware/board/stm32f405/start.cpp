// From the boot loader to main().
#include "firmware/board/stm32f405/crash.h"
#include "firmware/board/stm32f405/memory.h"
#include "firmware/board/stm32f405/peripherals.h"

int main();

namespace hoof::firmware::stm32f405 {
namespace {

#define HOOF_START [[gnu::section(".start"), gnu::noinline]]

/// Before any function that may use a floating-point register. Lazy stacking, the state after
/// reset, stays.
HOOF_START void start_fpu() {
  scb_registers().CPACR.set(scb::kFpuAccess);
  asm volatile("dsb\n\tisb" ::: "memory");
}

/// Faults get their own handlers; the 4 KB below the stack and the first 64 KB of the address
/// space, where null pointers lead, may not be touched. (Vectors are fetched from where they are
/// linked.)
HOOF_START void arm_faults() {
  ScbRegisters& scb = scb_registers();
  scb.VTOR.write(reinterpret_cast<std::uintptr_t>(&hoof_vectors));
  scb.CCR.set(scb::kTrapDivisionByZero);
  scb.SHCSR.set(scb::kOwnFaults);
  MpuRegisters& mpu = mpu_registers();
  mpu.RNR.write(0);
  mpu.RBAR.write(kStackBottom - 4096);
  mpu.RASR.write(mpu::no_access(12));
  mpu.RNR.write(1);
  mpu.RBAR.write(0);
  mpu.RASR.write(mpu::no_access(16));
  mpu.CTRL.write(mpu::kOnWithDefaultMap);
  asm volatile("dsb\n\tisb" ::: "memory");
}

/// Loops over volatile words, so that the compiler does not make them calls that may want data.
HOOF_START void fill_memory() {
  const volatile std::uint32_t* from = &hoof_data_load;
  for (volatile std::uint32_t* to = &hoof_data_start; to != &hoof_data_end; ++to) *to = *from++;
  for (volatile std::uint32_t* to = &hoof_bss_start; to != &hoof_bss_end; ++to) *to = 0;
}

HOOF_START void run_constructors() {
  for (const Constructor* each = &hoof_constructors_start; each != &hoof_constructors_end; ++each) {
    (*each)();
  }
}

}  // namespace

extern "C" {

HOOF_START [[noreturn, gnu::used]] void hoof_start() {
  start_fpu();
  arm_faults();
  fill_memory();
  run_constructors();
  main();
  panic(Panic::kMainEnded);
}

/// Paints the stack, which is still empty here, and goes on. No C++ may be in a naked function.
HOOF_START [[gnu::naked]] void hoof_reset() {
  asm volatile(
      "cpsid i\n\t"
      "ldr r0, =hoof_stack_bottom\n\t"
      "ldr r1, =hoof_stack_top\n\t"
      "ldr r2, =%c0\n\t"
      "msr msp, r1\n"
      "1:\n\t"
      "str r2, [r0], #4\n\t"
      "cmp r0, r1\n\t"
      "bne 1b\n\t"
      "b hoof_start\n\t"
      ".ltorg" ::"i"(kStackPaint));
}

}  // extern "C"

static_assert(kStackTop - kStackBottom == kStackBytes);

}  // namespace hoof::firmware::stm32f405
