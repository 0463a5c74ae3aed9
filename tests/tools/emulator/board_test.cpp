// The image on a board of its own: start, faults of board and image, and what is told of them.
#include "tools/emulator/board.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "hal/slcan/line.h"
#include "tests/tools/emulator/board_bench.h"

using namespace hoof::tools::emulator;
using namespace hoof;
namespace protocol = hoof::firmware::protocol;

namespace {

using Bench = test::BoardBench;
using test::kCrashRecord;
constexpr std::uint32_t kMagic = test::kCrashMagic;
constexpr std::uint32_t kUnexpectedReset = 1u << 19, kEmergency = 1u << 14;

}  // namespace

TEST_CASE("board: a blank part starts, readies its fault log, joins the bus and reports") {
  Bench bench;
  bench.board.power_on();
  CHECK(bench.flash.erases() == 1);  // the log's sector
  // A sector takes a quarter of a second, which the core waits for.
  CHECK(bench.board.now() >= 250 * kCyclesPerMillisecond);
  bench.run_ms(300);
  REQUIRE(bench.heartbeat());
  CHECK(bench.heartbeat()->mode == protocol::Mode::kOff);
  CHECK(bench.heartbeat()->faults == 0);
  CHECK(bench.board.resets() == 0);
  CHECK(bench.seen[0].size() >= 3);
  CHECK(bench.seen[0].size() <= 5);
}

TEST_CASE("board: a loop that hangs is ended by the watchdog within its time, and told") {
  const std::uint32_t oscillator_Hz = GENERATE(17'000u, 32'000u, 47'000u);
  CAPTURE(oscillator_Hz);
  Bench bench;
  bench.board.set_watchdog_oscillator_Hz(oscillator_Hz);
  bench.board.power_on();
  bench.run_ms(5);
  bench.replace_after_sleep(0xE7FE);  // b .
  const Cycles hung = bench.board.now();
  while (bench.board.resets() == 0 && bench.board.now() < hung + 100 * kCyclesPerMillisecond) {
    bench.board.advance_to(bench.board.now() + kCyclesPerMillisecond / 10);
  }
  CHECK(bench.board.last_reset() == hal::ResetCause::kWatchdog);
  // Set for 235 periods of four slow cycles.
  const double after_ms = double(bench.board.now() - hung) / kCyclesPerMillisecond;
  CHECK(after_ms == Approx(4 * 235 * 1e3 / oscillator_Hz).margin(1.2));
}

TEST_CASE("board: an undefined instruction leaves a crash record, and the next start tells it") {
  Bench bench;
  bench.board.power_on();
  bench.run_ms(3);
  const std::uint32_t pc = bench.board.cpu().registers().pc & ~1u;
  std::uint16_t good = 0;
  bench.board.cpu().read_memory(pc, &good, 2);
  const std::uint16_t undefined = 0xDE00;
  bench.board.cpu().write_memory(pc, &undefined, 2);
  bench.run_ms(2);  // it crashes whenever it wakes
  CHECK(bench.board.resets() >= 1);
  CHECK(bench.word(kCrashRecord) == kMagic);
  // Interrupts are masked there, so the usage fault may not run and becomes a hard fault.
  CHECK(bench.word(kCrashRecord + 8) == 3);
  CHECK(bench.word(kCrashRecord + 32) == 1u << 16);  // CFSR: undefined instruction
  CHECK(bench.word(kCrashRecord + 36) == 1u << 30);  // HFSR: forced
  CHECK(bench.word(kCrashRecord + 16) == pc);
  bench.board.cpu().write_memory(pc, &good, 2);
  bench.board.reset(hal::ResetCause::kSoftware);
  bench.run_ms(300);
  REQUIRE(bench.heartbeat());
  CHECK((bench.heartbeat()->faults & kUnexpectedReset) != 0);
  CHECK(bench.heartbeat()->mode == protocol::Mode::kFault);
}

TEST_CASE("board: a stack that has grown to its end is a recorded fault and no overwritten data") {
  Bench bench;
  bench.board.power_on();
  bench.run_ms(3);
  CoreRegisters r = bench.board.cpu().registers();
  const std::uint32_t bottom = 0x2000'0000;
  r.sp = bottom + 16;  // less than the frame of an interrupt
  bench.board.cpu().set_registers(r);
  bench.board.cpu().set_masks({});
  bench.run_ms(2);
  CHECK(bench.board.resets() >= 1);
  CHECK(bench.board.last_reset() == hal::ResetCause::kSoftware);
  CHECK(bench.word(kCrashRecord) == kMagic);
  CHECK(bench.word(kCrashRecord + 8) == 4);               // memory fault
  CHECK((bench.word(kCrashRecord + 32) & 1u << 4) != 0);  // CFSR: in pushing the frame
  CHECK(bench.word(kCrashRecord + 28) < bottom);
  bench.run_ms(300);
  REQUIRE(bench.heartbeat());
  CHECK((bench.heartbeat()->faults & kUnexpectedReset) != 0);
}

TEST_CASE("board: the line of the e-stop, and a wire that is cut") {
  Bench bench;
  bench.board.power_on();
  bench.run_ms(200);
  CHECK(bench.heartbeat()->faults == 0);
  bench.board.press_emergency_stop(true);
  bench.run_ms(20);
  CHECK((bench.heartbeat()->faults & kEmergency) != 0);
  CHECK(bench.heartbeat()->mode == protocol::Mode::kEmergencyOff);
}

TEST_CASE("board: without its crystal, or without its PLL, it lives and stays off the bus") {
  for (const ClockFaults faults : {ClockFaults{true, false}, ClockFaults{true, true}}) {
    Bench bench;
    bench.board.set_clock_faults(faults);
    bench.board.power_on();
    bench.run_ms(500);
    CHECK(bench.board.resets() == 0);
    CHECK(bench.seen[0].empty());
    CHECK(bench.seen[1].empty());
  }
}

TEST_CASE("board: its serial line in place of a bus, until somebody speaks on CAN") {
  Bench bench;
  bench.board.power_on();
  bench.run_ms(20);
  bench.board.hear(0, "\rV\r");
  CHECK(bench.board.take_said(0) == "\rV0100\r");
  const std::size_t by_can = bench.seen[0].size();
  bench.board.hear(0, "O\r");
  CHECK(bench.board.take_said(0) == "\r");
  bench.run_ms(300);
  CHECK(bench.seen[0].size() == by_can);
  // Heartbeats, every 100 ms, as lines.
  const std::string said = bench.board.take_said(0);
  std::size_t lines = 0, beats = 0, start = 0;
  for (std::size_t end; (end = said.find('\r', start)) != std::string::npos; start = end + 1) {
    hal::CanFrame frame;
    const auto* text = reinterpret_cast<const std::uint8_t*>(said.data() + start);
    ++lines;
    REQUIRE(hal::slcan::frame_of({text, end - start}, frame));
    protocol::Heartbeat h;
    beats += decode(frame, h) == protocol::DecodeResult::kOk ? 1 : 0;
  }
  CHECK(lines >= 3);
  CHECK(beats == 3);
  // At another baud rate nothing is understood.
  bench.board.hear(0, "V\r", 115'200);
  CHECK(bench.board.take_said(0).find('V') == std::string::npos);
  bench.board.hear(0, "\r");
  bench.board.take_said(0);
  // Somebody speaks on the other bus: both lines are shut, the frames go out by CAN again.
  hal::CanFrame frame;
  frame.id = protocol::spec(protocol::Message::kEmergencyStop).id;
  frame.length = 8;
  bench.coming[0].push_back(frame);
  bench.run_ms(300);
  CHECK(bench.seen[0].size() > by_can);
  bench.board.take_said(0);
  bench.board.hear(0, "O\r");
  CHECK(bench.board.take_said(0) == "\a");
  bench.run_ms(150);
  CHECK(bench.board.take_said(0).empty());
  bench.board.hear(1, "O\r");
  CHECK(bench.board.take_said(1) == "\a");
  // A reset opens them again.
  bench.board.reset(hal::ResetCause::kPin);
  bench.run_ms(20);
  bench.board.hear(1, "O\r");
  CHECK(bench.board.take_said(1) == "\r");
}

TEST_CASE("board: without its crystal it is off CAN, and can be spoken to by its serial line") {
  const bool pll_dead = GENERATE(false, true);
  CAPTURE(pll_dead);
  Bench bench;
  bench.board.set_clock_faults({.crystal_dead = true, .pll_dead = pll_dead});
  bench.board.power_on();
  bench.run_ms(20);
  bench.board.hear(0, "O\r");
  CHECK(bench.board.take_said(0).substr(0, 1) == "\r");  // then a heartbeat that was due
  bench.run_ms(250);
  CHECK(bench.seen[0].empty());
  CHECK(bench.board.take_said(0).find("t050") != std::string::npos);  // the next
}

TEST_CASE("board: a register without a model is named, with the place that asked for it") {
  // ldr r0, [pc, #4]; ldr r1, [r0]; b .; nop; the address
  ElfFile elf;
  const std::uint32_t address = 0x4000'1000;
  std::vector<std::uint8_t> code(64, 0);
  const auto put = [&](std::size_t at, std::uint32_t value, std::size_t bytes) {
    std::memcpy(code.data() + at, &value, bytes);
  };
  put(0, 0x2000'1000, 4);
  put(4, 0x0800'0021, 4);
  put(0x20, 0x4801, 2);
  put(0x22, 0x6801, 2);
  put(0x24, 0xE7FE, 2);
  put(0x28, address, 4);
  elf.segments.push_back({0x0800'0000, 0x0800'0000, code});
  elf.symbols.push_back({"asks", 0x0800'0020, 8, true});
  hal::RamFlash flash = blank_flash();
  Board board(elf, flash);
  CHECK_THROWS_WITH(board.power_on(), Catch::Contains("no model of a register at 0x40001000") &&
                                          Catch::Contains("(asks)"));
}
