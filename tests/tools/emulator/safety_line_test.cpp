// The image and the board around it: the line that lets the drives have torque, supply and
// temperature, clocks that stop. Each ends in a safe state and none bricks.
#include "tests/tools/emulator/board_bench.h"

using namespace hoof::tools::emulator;
using namespace hoof;
namespace protocol = hoof::firmware::protocol;
using protocol::Mode;
using protocol::Order;
using protocol::OrderResult;
using test::BoardBench;

namespace {

constexpr std::uint32_t kOverTemperature = 1u << 6, kEmergency = 1u << 14, kBrownOut = 1u << 18,
                        kUnexpectedReset = 1u << 19;
constexpr double kWave_Hz = 12'500;

/// Started, its log ready, the drives' line up.
struct RunningBoard : BoardBench {
  explicit RunningBoard(const BoardVoltages& voltages = {}) {
    board.set_voltages(voltages);
    board.power_on();
    run_ticks(150);
    REQUIRE(heartbeat());
    REQUIRE(heartbeat()->faults == 0);
    REQUIRE(board.drive_enable_Hz() == kWave_Hz);
  }
  float supply_V() const {
    const auto load = last<protocol::FootLoad>();
    REQUIRE(load);
    return load->supply_V;
  }
};

}  // namespace

TEST_CASE("e-stop: the break takes the drives' line away before the core runs one instruction") {
  RunningBoard foot;
  std::uint64_t instructions = 0;
  foot.board.cpu().observe([&](std::uint32_t) { ++instructions; });
  const std::uint64_t exceptions = foot.board.counts().exceptions;
  foot.board.press_emergency_stop(true);
  CHECK(foot.board.drive_enable_Hz() == 0);
  CHECK(instructions == 0);
  // The break's interrupt wakes the core at once, not with the next tick of SysTick.
  REQUIRE(foot.board.next_tick() > foot.board.now() + 1);
  foot.board.advance_to(foot.board.now() + 1);
  CHECK(instructions > 0);
  CHECK(foot.board.counts().exceptions >= exceptions + 1);
  foot.board.cpu().observe({});
  foot.run_ticks(20);
  CHECK(foot.heartbeat()->mode == Mode::kEmergencyOff);
  CHECK(foot.heartbeat()->faults == kEmergency);
  // While it is pressed no order gives the line back, and the core sleeps between its ticks.
  CHECK(foot.order(Order::kReset) == OrderResult::kWrongMode);
  CHECK(foot.board.drive_enable_Hz() == 0);
  const std::uint64_t before = foot.board.counts().exceptions;
  foot.run_ms(100);
  CHECK(foot.board.counts().exceptions - before < 200);
  // Released is not reset.
  foot.board.press_emergency_stop(false);
  foot.run_ticks(50);
  CHECK(foot.board.drive_enable_Hz() == 0);
  CHECK(foot.order(Order::kReset) == OrderResult::kAccepted);
  foot.run_ticks(10);
  CHECK(foot.board.drive_enable_Hz() == kWave_Hz);
  CHECK(foot.heartbeat()->mode == Mode::kOff);
  // The break is armed again.
  foot.board.press_emergency_stop(true);
  CHECK(foot.board.drive_enable_Hz() == 0);
  foot.run_ticks(20);
  CHECK(foot.heartbeat()->mode == Mode::kEmergencyOff);
  CHECK(foot.board.resets() == 0);
}

TEST_CASE("e-stop: a press that is over before the core wakes is an e-stop all the same") {
  RunningBoard foot;
  foot.board.press_emergency_stop(true);
  foot.board.press_emergency_stop(false);
  CHECK(foot.board.drive_enable_Hz() == 0);
  foot.run_ticks(30);
  CHECK(foot.heartbeat()->mode == Mode::kEmergencyOff);
  CHECK(foot.heartbeat()->faults == kEmergency);
  CHECK(foot.board.drive_enable_Hz() == 0);
  CHECK(foot.order(Order::kReset) == OrderResult::kAccepted);
  foot.run_ticks(10);
  CHECK(foot.board.drive_enable_Hz() == kWave_Hz);
}

TEST_CASE("e-stop: a frame takes the line away, too, and a button pressed at the start") {
  RunningBoard foot;
  foot.coming[0].push_back(encode(protocol::EmergencyStop{1, 0}));
  foot.run_ms(1);
  CHECK(foot.board.drive_enable_Hz() == 0);
  BoardBench pressed;
  pressed.board.press_emergency_stop(true);
  pressed.board.power_on();
  pressed.run_ticks(50);
  CHECK(pressed.board.drive_enable_Hz() == 0);
  CHECK(pressed.heartbeat()->mode == Mode::kEmergencyOff);
}

TEST_CASE("drives' line: a program gone wild cannot turn the break off") {
  RunningBoard foot;
  const std::uint32_t pc = foot.board.cpu().registers().pc & ~1u;
  const std::uint16_t code[] = {0x6448, 0x6188, 0xE7FE};  // str r0, [r1, #0x44]; [r1, #0x18]; b .
  REQUIRE(foot.board.cpu().write_memory(pc, code, sizeof code));
  CoreRegisters r = foot.board.cpu().registers();
  r.r0 = 0x8000;  // MOE alone
  r.r1 = 0x4001'0000;
  foot.board.cpu().set_registers(r);
  foot.board.advance_to(foot.board.now() + kCyclesPerMillisecond);
  CHECK(foot.board.stuck());
  CHECK(foot.board.drive_enable_Hz() == kWave_Hz);
  foot.board.press_emergency_stop(true);
  CHECK(foot.board.drive_enable_Hz() == 0);
}

TEST_CASE(
    "drives' line: gone with the supply, a crash, a hung loop, and down until a reset order") {
  const bool hangs = GENERATE(false, true);
  CAPTURE(hangs);
  RunningBoard foot;
  const std::uint32_t place = foot.board.cpu().registers().pc & ~1u;
  const std::uint16_t former = foot.replace_after_sleep(hangs ? 0xE7FE : 0xDE00);
  foot.run_ms(1);
  if (hangs) {
    CHECK(foot.board.stuck());
  } else {
    CHECK(foot.board.resets() >= 1);
  }
  for (int i = 0; i < 60 && foot.board.resets() == 0; ++i) foot.run_ms(1);
  REQUIRE(foot.board.resets() >= 1);
  // The instruction is good again, as after an upset.
  REQUIRE(foot.board.cpu().write_memory(place, &former, 2));
  foot.run_ticks(300);
  CHECK(foot.heartbeat()->mode == Mode::kFault);
  CHECK(foot.heartbeat()->faults == kUnexpectedReset);
  CHECK(foot.board.drive_enable_Hz() == 0);
  CHECK(foot.order(Order::kReset) == OrderResult::kAccepted);
  foot.run_ticks(10);
  CHECK(foot.board.drive_enable_Hz() == kWave_Hz);
}

TEST_CASE("supply: what is at the divider is told, and less than 36 V stops the foot") {
  for (const double analog_V : {3.15, 3.3, 3.45}) {
    CAPTURE(analog_V);
    RunningBoard foot({.supply_V = 48, .temperature_C = 30, .analog_V = analog_V});
    CHECK(foot.supply_V() == Approx(48).margin(0.25 / 2));  // a step of the dictionary's signal
    foot.board.set_voltages({.supply_V = 37, .temperature_C = 30, .analog_V = analog_V});
    foot.run_ticks(30);
    CHECK(foot.supply_V() == Approx(37).margin(0.25 / 2));
    CHECK(foot.heartbeat()->faults == 0);
  }
  // It falls for a tick, then for good.
  RunningBoard foot({.supply_V = 48});
  foot.board.set_voltages({.supply_V = 30});
  foot.run_ticks(1);
  foot.board.set_voltages({.supply_V = 48});
  foot.run_ticks(20);
  CHECK(foot.heartbeat()->faults == 0);
  foot.board.set_voltages({.supply_V = 30});
  foot.run_ticks(4);  // a conversion behind, and two in a row
  foot.run_ticks(10);
  CHECK(foot.heartbeat()->faults == kBrownOut);
  CHECK(foot.heartbeat()->mode == Mode::kFault);
  CHECK(foot.board.drive_enable_Hz() == 0);
  // The reset is of no use until it is back.
  foot.order(Order::kReset);
  foot.run_ticks(30);
  CHECK(foot.heartbeat()->faults == kBrownOut);
  foot.board.set_voltages({.supply_V = 48});
  foot.run_ticks(5);
  CHECK(foot.order(Order::kReset) == OrderResult::kAccepted);
  foot.run_ticks(30);
  CHECK(foot.heartbeat()->faults == 0);
}

TEST_CASE(
    "supply: not wired is not measured; a wire that is cut, or a dead converter, is a fault") {
  RunningBoard none;
  CHECK(none.supply_V() == 0);
  for (const bool dead : {false, true}) {
    CAPTURE(dead);
    RunningBoard foot({.supply_V = 48});
    if (dead) {
      foot.board.set_converter_dead(true);
    } else {
      foot.board.set_voltages({.supply_V = 0});
    }
    foot.run_ticks(50);
    CHECK(foot.heartbeat()->faults == kBrownOut);
    CHECK(foot.supply_V() == 0.25f);
  }
  none.board.set_converter_dead(true);
  none.run_ticks(50);
  CHECK(none.heartbeat()->faults == 0);
}

TEST_CASE("temperature: the processor's own sensor, by the factory's calibration, stops at 100 C") {
  RunningBoard foot({.temperature_C = 98});
  foot.run_ticks(50);
  CHECK(foot.heartbeat()->faults == 0);
  foot.board.set_voltages({.temperature_C = 102});
  foot.run_ticks(50);
  CHECK(foot.heartbeat()->faults == kOverTemperature);
  CHECK(foot.heartbeat()->mode == Mode::kFault);
}

TEST_CASE("clock: a crystal that fails takes the line away at once; record, reset, off the bus") {
  RunningBoard foot;
  std::uint64_t instructions = 0;
  foot.board.cpu().observe([&](std::uint32_t) { ++instructions; });
  foot.board.set_clock_faults({.crystal_dead = true});
  CHECK(foot.board.drive_enable_Hz() == 0);
  CHECK(instructions == 0);
  foot.board.cpu().observe({});
  foot.run_ms(1);
  CHECK(foot.board.resets() == 1);
  CHECK(foot.board.last_reset() == hal::ResetCause::kSoftware);
  CHECK(foot.word(test::kCrashRecord) == test::kCrashMagic);
  CHECK(foot.word(test::kCrashRecord + 8) == 2);  // NMI
  foot.seen[0].clear();
  foot.run_ms(500);
  CHECK(foot.board.resets() == 1);
  CHECK(foot.seen[0].empty());
  CHECK(foot.board.drive_enable_Hz() == 0);
  // The serial line tells why; a crystal that is back after the next reset brings it back.
  foot.board.hear(0, "O\r");
  foot.run_ms(250);
  CHECK(foot.board.take_said(0).find("t050") != std::string::npos);
  foot.board.set_clock_faults({});
  foot.board.reset(hal::ResetCause::kPin);
  foot.run_ticks(150);
  CHECK(foot.heartbeat()->mode == Mode::kOff);
  CHECK(foot.heartbeat()->faults == 0);
}

TEST_CASE("clock: a SysTick that stands ends in the watchdog, with SYNC and without") {
  const bool sync = GENERATE(false, true);
  CAPTURE(sync);
  RunningBoard foot;
  foot.board.set_tick_stuck(true);
  int waited_ms = 0;
  for (; foot.board.resets() == 0 && waited_ms < 500; ++waited_ms) {
    sync ? foot.run_ticks(1) : foot.run_ms(1);
  }
  CAPTURE(waited_ms);
  CHECK(foot.board.last_reset() == hal::ResetCause::kWatchdog);
  // 29 ms at the oscillator's 32 kHz, and with SYNC the turns until the clock counts as dead.
  CHECK(waited_ms >= 29);
  CHECK(waited_ms <= (sync ? 130 : 31));
  // Nothing moves for as long as it lasts, and it comes back.
  for (int i = 0; i < 300; ++i) sync ? foot.run_ticks(1) : foot.run_ms(1);
  CHECK(foot.board.resets() >= 2);
  foot.board.set_tick_stuck(false);
  foot.run_ticks(300);
  CHECK(foot.heartbeat()->mode == Mode::kFault);
  CHECK(foot.heartbeat()->faults == kUnexpectedReset);
  CHECK(foot.order(Order::kReset) == OrderResult::kAccepted);
  foot.run_ticks(30);
  CHECK(foot.heartbeat()->mode == Mode::kOff);
}
