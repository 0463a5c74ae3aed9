// Time by a serial line: where it can be, and that it is obeyed there word for word.
#include "firmware/board/stm32f405/lock_step_board.h"

#include <catch2/catch.hpp>
#include <deque>
#include <string>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;
using Word = LockStepBoard::Word;
namespace lock_step = hal::lock_step;

namespace {

/// A USART as QEMU's: sends at once, and its interrupt is for bytes received alone.
struct Usart {
  UsartRegisters registers;
  SerialLine line{registers};
  SerialBus bus{line};
  std::deque<std::uint8_t> coming;
  std::string sent;

  /// @param both what any line sends, in its order
  Usart(tests::SimulatedRegisters& access, std::string& both) {
    access.when_read(registers.SR, [this](hal::Register&) {
      return usart::kTransmitEmpty | (coming.empty() ? 0 : usart::kReceived);
    });
    access.when_read(registers.DR, [this](hal::Register&) {
      const std::uint32_t byte = coming.front();
      coming.pop_front();
      return byte;
    });
    access.when_written(registers.DR, [this, &both](hal::Register&, std::uint32_t v) {
      sent.push_back(char(v));
      both.push_back(char(v));
    });
  }
  void hear(std::string_view text) {
    coming.insert(coming.end(), text.begin(), text.end());
    while (!coming.empty()) line.on_interrupt(bus, 0);
  }
  void hear(const hal::CanFrame& frame) {
    const auto line_of_frame = hal::slcan::line_of(frame);
    const auto* text = reinterpret_cast<const char*>(line_of_frame.text.data());
    hear({text, line_of_frame.length});
  }
  std::string take_sent() { return std::exchange(sent, {}); }
};

hal::CanFrame frame_of(std::uint32_t id) {
  hal::CanFrame frame;
  frame.id = id;
  return frame;
}

std::string line(const hal::CanFrame& frame) {
  const auto l = hal::slcan::line_of(frame);
  return {l.text.begin(), l.text.begin() + std::ptrdiff_t(l.length)};
}

struct Rig {
  tests::SimulatedRegisters access;
  std::string both;
  Usart usart0{access, both}, usart1{access, both};
  LockStepBoard board{usart0.line, usart0.bus, usart1.line, usart1.bus};
  hal::CanBus& bus0 = *board.buses()[0];
  hal::CanBus& bus1 = *board.buses()[1];

  Rig() {
    for (Usart* u : {&usart0, &usart1}) u->hear("O\r");
    CHECK(board.next_word() == Word::kNone);
    CHECK(usart0.take_sent() == "\r");
    CHECK(usart1.take_sent() == "\r");
  }
  void begin() {
    usart0.hear(lock_step::begin());
    REQUIRE(board.next_word() == Word::kBegin);
    board.answer(0);
    CHECK(usart0.take_sent() == "Z\r" + line(encode(lock_step::Done{0, 0})));
  }
};

}  // namespace

TEST_CASE("lock-step board: only where nothing of the part answers") {
  RccRegisters rcc;
  GpioRegisters port_a, port_b;
  hal::bxcan::Registers can;
  CHECK(only_core_and_lines(rcc, port_a, port_b, can));
  // One register that is there is enough; the values are those after reset (RM0090).
  struct Case {
    hal::Register& target;
    std::uint32_t after_reset;
  };
  for (const Case& c : {Case{rcc.CR, 0x0000'0083}, Case{port_a.MODER, 0xA800'0000},
                        Case{port_b.MODER, 0x0000'0280}, Case{can.MCR, 0x0001'0002}}) {
    c.target.store(c.after_reset);
    CHECK_FALSE(only_core_and_lines(rcc, port_a, port_b, can));
    c.target.store(1u << 31);
    CHECK_FALSE(only_core_and_lines(rcc, port_a, port_b, can));
    c.target.store(0);
    CHECK(only_core_and_lines(rcc, port_a, port_b, can));
  }
}

TEST_CASE("lock-step board: nothing goes before Begin, which is obeyed once") {
  Rig rig;
  rig.usart0.hear(encode(lock_step::Go{.time_ns = 1'000'000}));
  CHECK(rig.board.next_word() == Word::kNone);
  CHECK(rig.usart0.take_sent() == "Z\r");
  CHECK(rig.board.clock().now_ns() == 0);
  rig.begin();
  rig.usart0.hear(lock_step::begin());
  CHECK(rig.board.next_word() == Word::kNone);
  CHECK(rig.usart0.take_sent() == "Z\r");
  hal::CanFrame other_version = lock_step::begin();
  ++other_version.data[0];
  Rig fresh;
  fresh.usart0.hear(other_version);
  CHECK(fresh.board.next_word() == Word::kNone);
}

TEST_CASE("lock-step board: a step brings time, frames of both lines and room for answers") {
  Rig rig;
  rig.begin();
  hal::CanFrame frame;
  rig.usart1.hear(frame_of(0x201));
  rig.usart0.hear(frame_of(0x101));
  CHECK(rig.board.next_word() == Word::kNone);
  rig.usart0.hear(frame_of(0x102));
  rig.usart0.hear(encode(lock_step::Go{.time_ns = 50'000, .free = {2, 1}}));
  REQUIRE(rig.board.next_word() == Word::kGo);
  CHECK(rig.usart0.take_sent() == "z\rz\rZ\r");
  CHECK(rig.usart1.take_sent() == "z\r");
  CHECK(rig.board.clock().now_ns() == 50'000);
  for (const std::uint32_t id : {0x101u, 0x102u}) {
    REQUIRE(rig.bus0.receive(frame));
    CHECK(frame.id == id);
  }
  CHECK_FALSE(rig.bus0.receive(frame));
  REQUIRE(rig.bus1.receive(frame));
  CHECK(frame.id == 0x201);
  CHECK(rig.bus0.status().free == 2);
  CHECK(rig.bus0.send(frame_of(0x301)) == hal::SendResult::kQueued);
  CHECK(rig.bus0.send(frame_of(0x302)) == hal::SendResult::kQueued);
  CHECK(rig.bus0.send(frame_of(0x303)) == hal::SendResult::kFull);
  CHECK(rig.bus1.send(frame_of(0x401)) == hal::SendResult::kQueued);
  CHECK(rig.bus1.send(frame_of(0x402)) == hal::SendResult::kFull);
  rig.both.clear();
  // Due 1.5 us later: asked after two whole ones.
  rig.board.answer(51'500);
  CHECK(rig.usart1.sent == "t4010\r");
  const std::string done = line(encode(lock_step::Done{50, 2}));
  CHECK(rig.usart0.take_sent() == "t3010\rt3020\r" + done);
  CHECK(rig.both.ends_with(done));
}

TEST_CASE("lock-step board: bus-off, steps nobody waits for, time that goes back") {
  Rig rig;
  rig.begin();
  rig.usart0.hear(
      encode(lock_step::Go{.time_ns = 2'000, .answer = false, .bus_off = {true, false}}));
  REQUIRE(rig.board.next_word() == Word::kGo);
  CHECK(rig.bus0.status().bus_off);
  CHECK_FALSE(rig.bus1.status().bus_off);
  CHECK(rig.bus0.send(frame_of(1)) == hal::SendResult::kBusOff);
  CHECK(rig.bus1.send(frame_of(2)) == hal::SendResult::kQueued);
  rig.usart0.take_sent();
  rig.board.answer(0);
  CHECK(rig.usart0.take_sent().empty());
  CHECK(rig.usart1.take_sent() == "t0020\r");
  rig.usart0.hear(encode(lock_step::Go{.time_ns = 1'000}));
  CHECK(rig.board.next_word() == Word::kNone);
  CHECK(rig.board.clock().now_ns() == 2'000);
  rig.usart0.hear(lock_step::end());
  CHECK(rig.board.next_word() == Word::kNone);
}
