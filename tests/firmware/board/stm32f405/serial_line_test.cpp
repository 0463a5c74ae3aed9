// The USART's driver over simulated registers.
#include "firmware/board/stm32f405/serial_line.h"

#include <catch2/catch.hpp>
#include <deque>
#include <string>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;

namespace {

/// A USART that sends each byte at once and hands over what a test puts in.
struct Rig {
  tests::SimulatedRegisters access;
  UsartRegisters registers;
  SerialLine line{registers};
  hal::slcan::SlcanBus<SerialLine> bus{line};
  std::string sent;
  std::deque<std::uint8_t> coming;
  std::uint32_t errors = 0;

  Rig() {
    access.when_read(registers.SR, [this](hal::Register&) {
      return usart::kTransmitEmpty | errors | (coming.empty() ? 0 : usart::kReceived);
    });
    access.when_read(registers.DR, [this](hal::Register&) {
      errors = 0;
      if (coming.empty()) return 0u;
      const std::uint32_t byte = coming.front();
      coming.pop_front();
      return byte;
    });
    access.when_written(registers.DR,
                        [this](hal::Register&, std::uint32_t v) { sent.push_back(char(v)); });
  }
  bool interrupts() const {
    const std::uint32_t control = registers.CR1.stored();
    const bool empty = (control & usart::kTransmitEmptyInterrupt) != 0;
    const bool received = (control & usart::kReceivedInterrupt) != 0;
    return empty || (received && (!coming.empty() || errors != 0));
  }
  void serve() {
    for (int i = 0; i < 5000 && interrupts(); ++i) line.on_interrupt(bus, 42);
    CHECK_FALSE(interrupts());
  }
  void hear(const std::string& text) {
    coming.insert(coming.end(), text.begin(), text.end());
    serve();
  }
};

}  // namespace

TEST_CASE("serial line: 1 Mbit/s from the clocks there are, within what a receiver bears") {
  struct Case {
    std::uint32_t clock_Hz, divider;
  };
  // USART1 on APB2, USART2 on APB1; 16 MHz where the PLL does not lock.
  for (const Case& c : {Case{84'000'000, 84}, Case{42'000'000, 42}, Case{16'000'000, 16}}) {
    Rig rig;
    rig.line.start(c.clock_Hz);
    CHECK(rig.registers.BRR.stored() == c.divider);
    CHECK(rig.registers.CR1.stored() == 0x202C);  // UE, RXNEIE, TE, RE
  }
}

TEST_CASE("serial line: an answer goes out byte by byte, then the line is quiet") {
  Rig rig;
  rig.line.start(84'000'000);
  rig.hear("O\r");
  CHECK(rig.sent == "\r");
  CHECK(rig.bus.open());
  rig.sent.clear();
  hal::CanFrame frame;
  frame.id = 0x123;
  frame.length = 1;
  frame.data[0] = 0x5A;
  CHECK(rig.bus.send(frame) == hal::SendResult::kQueued);
  CHECK(rig.sent.empty());
  rig.serve();
  CHECK(rig.sent == "t12315A\r");
  rig.hear("t0120\r");
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame.id == 0x012);
  CHECK(frame.stamp_ns == 42);
}

TEST_CASE("serial line: a full buffer takes whole lines or none, and goes on where it ended") {
  Rig rig;
  rig.line.start(84'000'000);
  rig.hear("O\r");
  rig.sent.clear();
  hal::CanFrame frame;
  frame.id = 0x100;
  frame.length = 8;
  std::string expected;
  int sent = 0;
  for (int round = 0; round < 50; ++round) {
    for (;; ++sent) {
      frame.data[0] = std::uint8_t(sent);
      if (rig.bus.send(frame) == hal::SendResult::kFull) break;
      const auto line = hal::slcan::line_of(frame);
      expected.append(line.bytes().begin(), line.bytes().end());
    }
    rig.serve();
  }
  CHECK(sent == 50 * int(SerialLine::kBuffer / 22));
  CHECK(rig.sent == expected);
  CHECK(rig.line.room() == SerialLine::kBuffer);
}

TEST_CASE("serial line: a line in which a byte was lost or noisy is refused, the next is not") {
  for (const std::uint32_t error : {usart::kOverrun, usart::kNoise, usart::kFramingError}) {
    Rig rig;
    rig.line.start(84'000'000);
    rig.hear("O\r");
    rig.hear("t12");
    rig.errors = error;
    rig.hear("30\r");
    CHECK_FALSE(rig.bus.frame_waiting());
    CHECK(rig.sent == "\r\a");
    rig.hear("t1230\r");
    CHECK(rig.bus.frame_waiting());
  }
}
