// Universal synchronous asynchronous receiver transmitter, as a line of bytes.
//
// Source: RM0090 rev. 19, 30.6. A byte takes no time on the line: one written to DR has left, and
// the next that comes is there once the one before it was read. 16 samples a bit, 8 data bits, no
// parity, one stop bit; nothing else has a model.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "tools/emulator/nvic.h"
#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class Usart final : public Peripheral {
 public:
  /// @param clock_MHz of the peripheral now
  Usart(int number, int interrupt, Nvic& nvic, std::function<std::uint32_t()> clock_MHz)
      : name_("USART" + std::to_string(number)),
        exception_(exception::kFirstInterrupt + interrupt),
        nvic_(nvic),
        clock_MHz_(std::move(clock_MHz)) {}

  const char* name() const override { return name_.c_str(); }
  std::uint32_t read(std::uint32_t offset) override;
  void write(std::uint32_t offset, std::uint32_t value) override;
  void reset() override;

  /// Bytes come, at this baud rate. At one that is off by more than 3 % they are not understood.
  void receive(const std::string& bytes, std::uint32_t baud);
  /// What was sent since the last call.
  std::string take_sent() { return std::exchange(sent_, {}); }
  /// 0 while it is off.
  std::uint32_t baud() const;

 private:
  void update_line();

  std::string name_;
  int exception_;
  Nvic& nvic_;
  std::function<std::uint32_t()> clock_MHz_;
  std::uint32_t divider_ = 0, control1_ = 0;
  std::deque<std::uint8_t> coming_;
  bool overrun_ = false;
  bool overrun_seen_ = false;  // SR was read with it: reading DR clears it
  std::string sent_;
};

}  // namespace hoof::tools::emulator
