// The Cortex-M4's own registers: SysTick, NVIC, system control, MPU.
//
// Sources: ARM DDI 0403E (ARMv7-M), B3.2 to B3.5; checked against PM0214 rev. 10, 4.2 to 4.5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct SysTickRegisters {
  hal::Register CSR;
  hal::Register RVR;
  hal::Register CVR;
};

struct NvicRegisters {
  std::array<hal::Register, 8> ISER;
  std::array<hal::Register, 184> reserved_020;
  std::array<hal::Register, 60> IPR;  // a byte an interrupt, of which the upper four bits count
};
static_assert(offsetof(NvicRegisters, IPR) == 0x300);

struct ScbRegisters {
  hal::Register CPUID;
  hal::Register ICSR;
  hal::Register VTOR;
  hal::Register AIRCR;
  hal::Register SCR;
  hal::Register CCR;
  std::array<hal::Register, 3> SHPR;
  hal::Register SHCSR;
  hal::Register CFSR;
  hal::Register HFSR;
  hal::Register DFSR;
  hal::Register MMFAR;
  hal::Register BFAR;
  std::array<hal::Register, 19> reserved_3C;
  hal::Register CPACR;
};
static_assert(offsetof(ScbRegisters, SHCSR) == 0x24 && offsetof(ScbRegisters, BFAR) == 0x38);
static_assert(offsetof(ScbRegisters, CPACR) == 0x88);

struct MpuRegisters {
  hal::Register TYPE;
  hal::Register CTRL;
  hal::Register RNR;
  hal::Register RBAR;
  hal::Register RASR;
};

namespace systick {
inline constexpr std::uint32_t kRun = 7u;  // CSR: core clock, interrupt, on
}

namespace scb {
// ICSR
inline constexpr std::uint32_t kActiveException = 0x1FF;
inline constexpr std::uint32_t kClearPendingTick = 1u << 25;
inline constexpr std::uint32_t kPendingTick = 1u << 26;
// AIRCR: key and SYSRESETREQ
inline constexpr std::uint32_t kReset = 0x05FA'0004;
// CCR
inline constexpr std::uint32_t kTrapDivisionByZero = 1u << 4;
// SHCSR: usage, bus and memory faults by their own handlers
inline constexpr std::uint32_t kOwnFaults = 7u << 16;
// CFSR: the frame could not be pushed; bus, memory
inline constexpr std::uint32_t kStackingFailed = 1u << 12 | 1u << 4;
// CPACR: CP10 and CP11, the FPU
inline constexpr std::uint32_t kFpuAccess = 0xFu << 20;
}  // namespace scb

namespace mpu {
inline constexpr std::uint32_t kOnWithDefaultMap = 1u << 0 | 1u << 2;  // CTRL
/// RASR of a region of 2^bits bytes that nobody may touch.
constexpr std::uint32_t no_access(std::uint32_t bits) {
  return 1u << 28 | (bits - 1) << 1 | 1u;
}
}  // namespace mpu

}  // namespace hoof::firmware::stm32f405
