// A USART with a buffer to send from; each byte that comes is handed on in the interrupt.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware/board/stm32f405/registers/usart.h"
#include "hal/slcan/slcan_bus.h"

namespace hoof::firmware::stm32f405 {

/// 8 data bits, no parity, one stop bit.
class SerialLine {
 public:
  static constexpr std::uint32_t kBaud = 1'000'000;
  static constexpr std::size_t kBuffer = 512;  // bytes

  explicit SerialLine(UsartRegisters& registers) : registers_(registers) {}

  /// @param clock_Hz of the peripheral  @pre that clock and the pins are on
  void start(std::uint32_t clock_Hz);

  /// From the interrupt, or with interrupts masked.
  /// @return false where there is no room for all of it: nothing is sent then
  bool write(std::span<const std::uint8_t> bytes);
  std::size_t room() const { return kBuffer - (written_ - sent_); }
  bool all_sent() const { return written_ == sent_; }

  void on_interrupt(hal::slcan::SlcanBus<SerialLine>& listener, std::int64_t now_ns);

 private:
  UsartRegisters& registers_;
  std::array<std::uint8_t, kBuffer> buffer_{};
  volatile std::uint32_t written_ = 0, sent_ = 0;  // both count on for ever, past 2^32
};

}  // namespace hoof::firmware::stm32f405
