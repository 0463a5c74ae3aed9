#include "firmware/board/stm32f405/pins.h"

namespace hoof::firmware::stm32f405 {
namespace {

constexpr std::uint32_t kAlternate = 2;
constexpr std::uint32_t kAnalog = 3;
constexpr std::uint32_t kFast = 2;
constexpr std::uint32_t kPullUp = 1;
constexpr std::uint32_t kPullDown = 2;
constexpr std::uint32_t kCanFunction = 9, kSerialFunction = 7, kTimerFunction = 1;

void set_field(hal::Register& target, std::uint32_t width, std::uint32_t index,
               std::uint32_t value) {
  const std::uint32_t mask = (1u << width) - 1;
  target.change(mask << (width * index), value << (width * index));
}

/// Pull first, function last: the pin never drives or reads anything by chance.
void configure(GpioRegisters& port, Pin pin, std::uint32_t function, std::uint32_t pull) {
  set_field(port.PUPDR, 2, pin.number, pull);
  set_field(port.OSPEEDR, 2, pin.number, kFast);
  set_field(port.AFR[pin.number / 8], 4, pin.number % 8, function);
  set_field(port.MODER, 2, pin.number, kAlternate);
}

}  // namespace

void configure_pins(GpioRegisters& port_a, GpioRegisters& port_b, GpioRegisters& port_c) {
  // Recessive, idle, where nothing is connected.
  for (const Pin pin : {kCan1ReceivePin, kCan1TransmitPin, kCan2ReceivePin, kCan2TransmitPin}) {
    configure(port_b, pin, kCanFunction, kPullUp);
  }
  for (const Pin pin :
       {kSerial0TransmitPin, kSerial0ReceivePin, kSerial1TransmitPin, kSerial1ReceivePin}) {
    configure(port_a, pin, kSerialFunction, kPullUp);
  }
  // Pressed, and off, where nothing is connected.
  configure(port_b, kEmergencyStopPin, kTimerFunction, kPullDown);
  configure(port_a, kDriveEnablePin, kTimerFunction, kPullDown);
  set_field(port_c.MODER, 2, kSupplyPin.number, kAnalog);
}

}  // namespace hoof::firmware::stm32f405
