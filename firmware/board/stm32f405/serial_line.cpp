#include "firmware/board/stm32f405/serial_line.h"

namespace hoof::firmware::stm32f405 {

void SerialLine::start(std::uint32_t clock_Hz) {
  registers_.BRR.write((clock_Hz + kBaud / 2) / kBaud);
  registers_.CR1.write(usart::kOn | usart::kReceiverOn | usart::kTransmitterOn |
                       usart::kReceivedInterrupt);
}

bool SerialLine::write(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > room()) return false;
  std::uint32_t written = written_;
  for (const std::uint8_t byte : bytes) buffer_[written++ % kBuffer] = byte;
  written_ = written;
  registers_.CR1.set(usart::kTransmitEmptyInterrupt);
  return true;
}

void SerialLine::on_interrupt(hal::slcan::SlcanBus<SerialLine>& listener, std::int64_t now_ns) {
  const std::uint32_t status = registers_.SR.read();
  if ((status & (usart::kReceived | usart::kLost)) != 0) {
    const std::uint32_t byte = registers_.DR.read();  // clears both
    if ((status & usart::kLost) != 0) listener.on_lost_byte();
    if ((status & usart::kReceived) != 0) {
      listener.on_byte(static_cast<std::uint8_t>(byte), now_ns);
    }
  }
  if ((status & usart::kTransmitEmpty) == 0) return;
  if (sent_ == written_) {
    registers_.CR1.clear(usart::kTransmitEmptyInterrupt);
    return;
  }
  registers_.DR.write(buffer_[sent_ % kBuffer]);
  sent_ = sent_ + 1;
}

}  // namespace hoof::firmware::stm32f405
