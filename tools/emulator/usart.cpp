#include "tools/emulator/usart.h"

#include <cmath>

namespace hoof::tools::emulator {
namespace {

enum Offset { kStatus = 0x0, kData = 0x4, kDivider = 0x8, kControl1 = 0xC };
constexpr std::uint32_t kOverrun = 1u << 3;
constexpr std::uint32_t kReceived = 1u << 5, kComplete = 1u << 6, kEmpty = 1u << 7;
constexpr std::uint32_t kReceiverOn = 1u << 2, kTransmitterOn = 1u << 3, kOn = 1u << 13;
constexpr std::uint32_t kModelled = kReceiverOn | kTransmitterOn | kOn | kReceived | kEmpty;
constexpr double kUnderstood = 0.03;  // of the baud rate

}  // namespace

void Usart::reset() {
  divider_ = control1_ = 0;
  coming_.clear();
  overrun_ = overrun_seen_ = false;
  update_line();
}

std::uint32_t Usart::baud() const {
  if ((control1_ & kOn) == 0 || divider_ == 0) return 0;
  return clock_MHz_() * 1'000'000 / divider_;
}

void Usart::receive(const std::string& bytes, std::uint32_t baud) {
  if ((control1_ & (kOn | kReceiverOn)) != (kOn | kReceiverOn)) return;
  const double off = std::abs(double(this->baud()) / baud - 1);
  for (const char c : bytes) {
    if (off > kUnderstood) {
      overrun_ = true;  // some error; which one is chance
    } else {
      coming_.push_back(std::uint8_t(c));
    }
  }
  update_line();
}

std::uint32_t Usart::read(std::uint32_t offset) {
  std::uint32_t value = 0;
  switch (offset) {
    case kStatus:
      overrun_seen_ = overrun_;
      return kComplete | kEmpty | (coming_.empty() ? 0 : kReceived) | (overrun_ ? kOverrun : 0);
    case kData:
      if (overrun_seen_) overrun_ = overrun_seen_ = false;
      if (!coming_.empty()) {
        value = coming_.front();
        coming_.pop_front();
      }
      // The next one, if any, is a new edge.
      nvic_.set_line(exception_, false);
      update_line();
      return value;
    case kDivider:
      return divider_;
    case kControl1:
      return control1_;
    default:
      no_such_register(offset);
  }
}

void Usart::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kData:
      if ((control1_ & (kOn | kTransmitterOn)) != (kOn | kTransmitterOn)) {
        throw EmulatorError(name_ + ": a byte is sent while the transmitter is off");
      }
      sent_.push_back(char(value));
      return;
    case kDivider:
      divider_ = value & 0xFFFF;
      return;
    case kControl1:
      if ((value & ~kModelled) != 0) {
        throw EmulatorError(name_ + " has no model of CR1 = " + hex(value));
      }
      control1_ = value;
      return update_line();
    default:
      no_such_register(offset);
  }
}

void Usart::update_line() {
  const bool received = (control1_ & kReceived) != 0 && (!coming_.empty() || overrun_);
  const bool empty = (control1_ & kOn) != 0 && (control1_ & kEmpty) != 0;
  nvic_.set_line(exception_, received || empty);
}

}  // namespace hoof::tools::emulator
