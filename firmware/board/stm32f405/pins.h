// Which pins do what.
#pragma once

#include <cstdint>

#include "firmware/board/stm32f405/registers/gpio.h"

namespace hoof::firmware::stm32f405 {

struct Pin {
  std::uint32_t number;
  constexpr std::uint32_t bit() const { return 1u << number; }
};

// Port B, alternate function 9 (DS8626, table 9).
inline constexpr Pin kCan1ReceivePin{8};
inline constexpr Pin kCan1TransmitPin{9};
inline constexpr Pin kCan2ReceivePin{5};
inline constexpr Pin kCan2TransmitPin{6};
// Port A, alternate function 7 (DS8626, table 9): the serial lines in place of CAN1 and CAN2.
inline constexpr Pin kSerial0TransmitPin{9};
inline constexpr Pin kSerial0ReceivePin{10};
inline constexpr Pin kSerial1TransmitPin{2};
inline constexpr Pin kSerial1ReceivePin{3};

// Alternate function 1 (DS8626, table 9): the break input of TIM1 on port B, and the output that it
// takes away on port A. The firmware reads the input's level, too.
inline constexpr Pin kEmergencyStopPin{12};
inline constexpr Pin kDriveEnablePin{8};

/// Port C: channel 10 of ADC1.
inline constexpr Pin kSupplyPin{0};

/// @pre the ports have their clocks
void configure_pins(GpioRegisters& port_a, GpioRegisters& port_b, GpioRegisters& port_c);

}  // namespace hoof::firmware::stm32f405
