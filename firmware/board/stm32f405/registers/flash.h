// Flash interface.
//
// Sources: RM0090 rev. 19, 3.9; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, FLASH_TypeDef and the bits FLASH_*).
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct FlashRegisters {
  hal::Register ACR;
  hal::Register KEYR;
  hal::Register OPTKEYR;
  hal::Register SR;
  hal::Register CR;
};

static_assert(offsetof(FlashRegisters, SR) == 0x0C && offsetof(FlashRegisters, CR) == 0x10);

namespace flash {

// ACR
inline constexpr std::uint32_t kLatencyMask = 7u;
inline constexpr std::uint32_t kLatency168MHz = 5u;  // at 2.7 to 3.6 V (RM0090, 3.5.1)
inline constexpr std::uint32_t kPrefetch = 1u << 8;
inline constexpr std::uint32_t kInstructionCache = 1u << 9;
inline constexpr std::uint32_t kDataCache = 1u << 10;
inline constexpr std::uint32_t kDataCacheReset = 1u << 12;

// KEYR
inline constexpr std::uint32_t kKey1 = 0x4567'0123;
inline constexpr std::uint32_t kKey2 = 0xCDEF'89AB;

// SR; errors and the end of operation are cleared by writing 1
inline constexpr std::uint32_t kEndOfOperation = 1u << 0;
inline constexpr std::uint32_t kOperationError = 1u << 1;
inline constexpr std::uint32_t kWriteProtected = 1u << 4;
inline constexpr std::uint32_t kAlignmentError = 1u << 5;
inline constexpr std::uint32_t kParallelismError = 1u << 6;
inline constexpr std::uint32_t kSequenceError = 1u << 7;
inline constexpr std::uint32_t kErrors =
    kOperationError | kWriteProtected | kAlignmentError | kParallelismError | kSequenceError;
inline constexpr std::uint32_t kBusy = 1u << 16;

// CR
inline constexpr std::uint32_t kProgram = 1u << 0;
inline constexpr std::uint32_t kSectorErase = 1u << 1;
inline constexpr unsigned kSectorShift = 3;
inline constexpr std::uint32_t kBy32Bits = 2u << 8;  // PSIZE; allowed from 2.7 V on
inline constexpr std::uint32_t kStart = 1u << 16;
inline constexpr std::uint32_t kLock = 1u << 31;

}  // namespace flash
}  // namespace hoof::firmware::stm32f405
