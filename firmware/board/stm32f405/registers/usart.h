// One USART.
//
// Sources: RM0090 rev. 19, 30.6; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, USART_TypeDef and the bits USART_*).
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct UsartRegisters {
  hal::Register SR;
  hal::Register DR;
  hal::Register BRR;  // peripheral clock over baud rate, at 16 samples a bit
  hal::Register CR1;
  hal::Register CR2;
  hal::Register CR3;
  hal::Register GTPR;
};

static_assert(offsetof(UsartRegisters, CR1) == 0x0C && offsetof(UsartRegisters, GTPR) == 0x18);

namespace usart {

// SR. The errors are cleared by reading SR, then DR.
inline constexpr std::uint32_t kParityError = 1u << 0;
inline constexpr std::uint32_t kFramingError = 1u << 1;
inline constexpr std::uint32_t kNoise = 1u << 2;
inline constexpr std::uint32_t kOverrun = 1u << 3;
inline constexpr std::uint32_t kReceived = 1u << 5;       // RXNE
inline constexpr std::uint32_t kTransmitEmpty = 1u << 7;  // TXE
inline constexpr std::uint32_t kLost = kFramingError | kNoise | kOverrun;

// CR1
inline constexpr std::uint32_t kReceiverOn = 1u << 2;
inline constexpr std::uint32_t kTransmitterOn = 1u << 3;
inline constexpr std::uint32_t kReceivedInterrupt = 1u << 5;
inline constexpr std::uint32_t kTransmitEmptyInterrupt = 1u << 7;
inline constexpr std::uint32_t kOn = 1u << 13;

}  // namespace usart
}  // namespace hoof::firmware::stm32f405
