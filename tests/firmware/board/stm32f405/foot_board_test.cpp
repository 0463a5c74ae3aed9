#include "firmware/board/stm32f405/foot_board.h"

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "firmware/app/received_ids.h"
#include "firmware/board/stm32f405/can_filters.h"
#include "tests/firmware/board/stm32f405/simulated_registers.h"
#include "tests/hal/bxcan/simulated_bxcan.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;
using hal::ResetCause;

namespace {

struct Rig {
  tests::SimulatedRegisters access;
  RccRegisters rcc;
  PwrRegisters pwr;
  GpioRegisters port_a, port, port_c;
  IwdgRegisters iwdg;
  AdcRegisters adc;
  AdcCommonRegisters adc_common;
  FactoryCalibration factory{1500, 960, 1207};
  TimerRegisters timer;
  Watchdog watchdog{iwdg};
  BoardMeter meter{adc, adc_common, factory};
  DriveEnable enable{timer};
  FootBoard board{rcc, pwr, port, watchdog, meter, enable};
};

/// Pins of an alternate function, with their pull-ups.
void check_pulled_up(const GpioRegisters& port, std::initializer_list<unsigned> pins,
                     unsigned function) {
  for (const unsigned pin : pins) {
    CAPTURE(pin);
    CHECK((port.MODER.stored() >> (2 * pin) & 3) == 2);
    CHECK((port.AFR[pin / 8].stored() >> (4 * (pin % 8)) & 15) == function);
    CHECK((port.PUPDR.stored() >> (2 * pin) & 3) == 1);
  }
}

}  // namespace

TEST_CASE("board: each cause of a reset, with what the part sets besides") {
  struct Case {
    const char* what;
    std::uint32_t csr;
    ResetCause cause;
  };
  // RM0090, 7.1 and 7.3: every reset drives the pin; switching on sets POR, BOR and PIN.
  const Case cases[] = {
      {"power on", 0x0E00'0003, ResetCause::kPowerOn},
      {"brown-out", 0x0600'0003, ResetCause::kBrownOut},
      {"pin", 0x0400'0003, ResetCause::kPin},
      {"software", 0x1400'0003, ResetCause::kSoftware},
      {"independent watchdog", 0x2400'0003, ResetCause::kWatchdog},
      {"window watchdog", 0x4400'0003, ResetCause::kWatchdog},
      {"low power", 0x8400'0003, ResetCause::kSoftware},
      {"none known", 0x0000'0003, ResetCause::kPowerOn},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    Rig rig;
    rig.rcc.CSR.store(c.csr);
    rig.board.start();
    CHECK(rig.board.reset_cause() == c.cause);
    CHECK((rig.rcc.CSR.stored() & rcc::kClearResetFlags) != 0);
    CHECK((rig.rcc.CSR.stored() & 3) == 3);  // the watchdog's oscillator is left alone
    rig.rcc.CSR.store(0);
    CHECK(rig.board.reset_cause() == c.cause);
  }
}

TEST_CASE("board: the e-stop's pin is low when pressed, cut or shorted to ground, pulled down") {
  Rig rig;
  configure_pins(rig.port_a, rig.port, rig.port_c);
  rig.port.IDR.store(0xFFFF);
  CHECK_FALSE(rig.board.emergency_stop_pressed());
  rig.port.IDR.store(0xFFFF & ~(1u << 12));
  CHECK(rig.board.emergency_stop_pressed());
  rig.port.IDR.store(0);
  CHECK(rig.board.emergency_stop_pressed());
  CHECK((rig.port.PUPDR.stored() >> 24 & 3) == 2);
  // TIM1's break input; the level can be read all the same.
  CHECK((rig.port.MODER.stored() >> 24 & 3) == 2);
  CHECK((rig.port.AFR[1].stored() >> 16 & 15) == 1);
}

TEST_CASE("board: a press too short to be read is told until the loop has acted upon it") {
  Rig rig;
  rig.port.IDR.store(0xFFFF);
  CHECK_FALSE(rig.board.emergency_stop_pressed());
  rig.timer.SR.store(timer::kBreak);
  CHECK(rig.board.emergency_stop_pressed());
  rig.board.allow_drives(true);
  CHECK(rig.board.emergency_stop_pressed());
  rig.board.allow_drives(false);
  CHECK_FALSE(rig.board.emergency_stop_pressed());
}

TEST_CASE("board: a watchdog is not fed by a loop whose clock stands") {
  Rig rig;
  int fed = 0;
  rig.access.when_written(rig.iwdg.KR, [&](hal::Register&, std::uint32_t) { ++fed; });
  std::int64_t now_ns = 5;
  const auto turn = [&] {
    rig.board.feed_watchdog();
    rig.board.note_time(std::uint32_t(now_ns));
  };
  for (int i = 0; i < 1000; ++i, now_ns += 6) turn();  // a cycle of the core goes by
  CHECK(fed == 1000);
  for (int i = 0; i < 1000; ++i) turn();
  CHECK(fed >= 1000 + int(FootBoard::kMostTurns));
  CHECK(fed <= 1002 + int(FootBoard::kMostTurns));
  now_ns += 6;  // it goes on
  fed = 0;
  for (int i = 0; i < 10; ++i) turn();
  CHECK(fed == 9);
}

TEST_CASE("board: the drives' line is TIM1's, low where nothing drives it; PC0 is analog") {
  Rig rig;
  configure_pins(rig.port_a, rig.port, rig.port_c);
  CHECK((rig.port_a.MODER.stored() >> 16 & 3) == 2);
  CHECK((rig.port_a.AFR[1].stored() & 15) == 1);
  CHECK((rig.port_a.PUPDR.stored() >> 16 & 3) == 2);
  CHECK(rig.port_c.MODER.stored() == 3);
  CHECK(rig.port_c.PUPDR.stored() == 0);
}

TEST_CASE("board: the CAN pins have their function, the pins of the debugger keep theirs") {
  Rig rig;
  rig.port.MODER.store(0x0000'0280);  // after reset: PB3, PB4 are the debugger's
  rig.port.PUPDR.store(0x0000'0100);
  configure_pins(rig.port_a, rig.port, rig.port_c);
  check_pulled_up(rig.port, {5u, 6u, 8u, 9u}, 9);
  CHECK((rig.port.MODER.stored() & 0x3FF) == 0x280);
  CHECK((rig.port.PUPDR.stored() & 0x3FF) == 0x100);
}

TEST_CASE("board: the serial pins have their function, SWD and USB keep theirs") {
  Rig rig;
  rig.port_a.MODER.store(0xA800'0000);  // after reset: PA13 to PA15 are the debugger's
  rig.port_a.PUPDR.store(0x6400'0000);
  configure_pins(rig.port_a, rig.port, rig.port_c);
  check_pulled_up(rig.port_a, {2u, 3u, 9u, 10u}, 7);
  CHECK((rig.port_a.MODER.stored() >> 22) == 0xA800'0000 >> 22);
  CHECK((rig.port_a.PUPDR.stored() >> 22) == 0x6400'0000 >> 22);
}

TEST_CASE("board: the supply's early warning, at the detector's highest level") {
  Rig rig;
  rig.board.start();
  CHECK((rig.pwr.CR.stored() & 0xF0) == 0xF0);
  CHECK_FALSE(rig.board.supply_low());
  rig.pwr.CSR.store(pwr::kSupplyBelow);
  CHECK(rig.board.supply_low());
  CHECK(rig.board.supply_V() == 0.0f);
}

TEST_CASE("board: the watchdog is unlocked for its settings, waited for, and fed") {
  Rig rig;
  std::vector<std::pair<std::string, std::uint32_t>> log;
  const auto note = [&log](const char* name) {
    return [&log, name](hal::Register& r, std::uint32_t value) {
      log.emplace_back(name, value);
      r.store(value);
    };
  };
  rig.access.when_written(rig.iwdg.KR, note("KR"));
  rig.access.when_written(rig.iwdg.PR, note("PR"));
  rig.access.when_written(rig.iwdg.RLR, note("RLR"));
  int updating = 5;
  rig.access.when_read(rig.iwdg.SR, [&](hal::Register&) { return updating-- > 0 ? 3u : 0u; });
  rig.watchdog.start(Watchdog::Time::kTick);
  rig.board.feed_watchdog();
  using Log = std::vector<std::pair<std::string, std::uint32_t>>;
  CHECK(
      log ==
      Log{{"KR", 0xCCCC}, {"KR", 0x5555}, {"PR", 0}, {"RLR", 234}, {"KR", 0xAAAA}, {"KR", 0xAAAA}});
  CHECK(updating < 0);
  // An oscillator that never answers does not hold the start up.
  rig.access.when_read(rig.iwdg.SR, [](hal::Register&) { return 3u; });
  rig.watchdog.set(Watchdog::Time::kStart);
  CHECK(rig.access.accesses < 100'000);
}

TEST_CASE("board: CAN lets through what the dictionary addresses to the foot, the e-stop apart") {
  tests::SimulatedBxCan can;
  REQUIRE(set_can_filters(can.registers));
  for (std::size_t bus = 0; bus < 2; ++bus) {
    std::set<std::uint32_t> wanted;
    firmware::app::for_each_received_id(bus, [&](std::uint32_t id) { wanted.insert(id); });
    REQUIRE_FALSE(wanted.empty());
    REQUIRE(wanted.count(firmware::app::kEmergencyStopId) == 1);  // on either bus
    for (std::uint32_t id = 0; id < 0x800; ++id) {
      CAPTURE(bus, id);
      const auto fifo = can.filtered(bus, id << 21);
      REQUIRE(fifo.has_value() == (wanted.count(id) == 1));
      if (fifo) REQUIRE(*fifo == (id == firmware::app::kEmergencyStopId ? 0 : 1));
    }
  }
}
