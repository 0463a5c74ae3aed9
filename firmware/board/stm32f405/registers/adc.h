// One analog-to-digital converter, and what all three share.
//
// Sources: RM0090 rev. 19, 13.13; checked against the device header of ST's cmsis_device_f4
// (stm32f405xx.h, ADC_TypeDef, ADC_Common_TypeDef and the bits ADC_*). Calibration values: DS8626,
// tables "Internal reference voltage calibration values" and "Temperature sensor calibration
// values"; checked against the addresses in ST's stm32f4xx_ll_adc.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/register.h"

namespace hoof::firmware::stm32f405 {

struct AdcRegisters {
  hal::Register SR;
  hal::Register CR1;
  hal::Register CR2;
  std::array<hal::Register, 2> SMPR;  // 3 bits a channel: 10 to 18 in the first, 0 to 9
  std::array<hal::Register, 4> JOFR;
  hal::Register HTR;
  hal::Register LTR;
  std::array<hal::Register, 3> SQR;
  hal::Register JSQR;
  std::array<hal::Register, 4> JDR;  // in the order of the injected conversions
  hal::Register DR;
};

static_assert(offsetof(AdcRegisters, SMPR) == 0x0C && offsetof(AdcRegisters, JSQR) == 0x38);
static_assert(offsetof(AdcRegisters, JDR) == 0x3C && offsetof(AdcRegisters, DR) == 0x4C);

/// From 0x300 behind the first converter on.
struct AdcCommonRegisters {
  hal::Register CSR;
  hal::Register CCR;
  hal::Register CDR;
};

/// Conversions that the factory made at 3.3 V, in system memory at 0x1FFF7A2A.
struct FactoryCalibration {
  volatile std::uint16_t reference;        // VREFINT_CAL, at 30 C
  volatile std::uint16_t temperature_30C;  // TS_CAL1
  volatile std::uint16_t temperature_110C;
};

static_assert(sizeof(FactoryCalibration) == 6);

namespace adc {

// SR; cleared by writing 0
inline constexpr std::uint32_t kInjectedEnd = 1u << 2;  // JEOC

// CR1, CR2
inline constexpr std::uint32_t kScan = 1u << 8;
inline constexpr std::uint32_t kOn = 1u << 0;              // ADON
inline constexpr std::uint32_t kStartInjected = 1u << 22;  // JSWSTART

// SMPR
inline constexpr std::uint32_t k480Cycles = 7;
constexpr std::uint32_t sampling(std::uint32_t channel, std::uint32_t code) {
  return code << (3 * (channel % 10));
}

/// JSQR of three conversions: JL = 2, and with that JSQ2 to JSQ4, in this order.
constexpr std::uint32_t injected(std::uint32_t first, std::uint32_t second, std::uint32_t third) {
  return 2u << 20 | third << 15 | second << 10 | first << 5;
}

// Channels of ADC1 on the inside
inline constexpr std::uint32_t kTemperature = 16;
inline constexpr std::uint32_t kReference = 17;

// CCR
inline constexpr std::uint32_t kClockBy4 = 1u << 16;
inline constexpr std::uint32_t kInsideOn = 1u << 23;  // TSVREFE

}  // namespace adc
}  // namespace hoof::firmware::stm32f405
