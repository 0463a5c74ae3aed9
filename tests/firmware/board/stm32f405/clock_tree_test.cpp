#include "firmware/board/stm32f405/clock_tree.h"

#include <catch2/catch.hpp>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;

namespace {

/// The clocks of the part, each of which may refuse to start. Checks what would hang or crash it.
struct SimulatedClocks {
  tests::SimulatedRegisters access;
  RccRegisters rcc;
  PwrRegisters pwr;
  FlashRegisters flash;
  bool crystal_works = true;
  int locks_that_work = 2;
  bool switch_works = true;
  bool fast_core_on_fast_flash = false;  // the fault: no wait states at 168 MHz

  SimulatedClocks() {
    rcc.CR.store(0x83);
    rcc.PLLCFGR.store(0x2400'3010);
    access.when_written(rcc.CR, [this](hal::Register& r, std::uint32_t value) {
      const bool pll_on = (value & rcc::kPllOn) != 0;
      const bool pll_was_on = (r.stored() & rcc::kPllOn) != 0;
      value &= ~rcc::kCrystalReady;
      if ((value & rcc::kCrystalOn) != 0 && crystal_works) value |= rcc::kCrystalReady;
      if (pll_on && !pll_was_on && locks_that_work-- > 0 && pll_input_runs(value)) {
        value |= rcc::kPllReady;
      }
      if (!pll_on) value &= ~rcc::kPllReady;
      r.store(value);
    });
    access.when_written(rcc.CFGR, [this](hal::Register& r, std::uint32_t value) {
      const std::uint32_t wanted = value & rcc::kSwitchMask;
      std::uint32_t in_use = r.stored() >> 2 & 3;
      if (wanted == 0 || (wanted == 2 && rcc.CR.has(rcc::kPllReady) && switch_works)) {
        in_use = wanted;
      }
      r.store((value & ~rcc::kSwitchedMask) | in_use << 2);
      if (in_use == 2 && (flash.ACR.stored() & 7) < 5) fast_core_on_fast_flash = true;
    });
  }
  bool pll_input_runs(std::uint32_t control) const {
    const bool crystal = (rcc.PLLCFGR.stored() & rcc::kPllFromCrystal) != 0;
    return !crystal || (control & rcc::kCrystalReady) != 0;
  }
  /// Of the PLL as configured. @return hertz
  std::uint32_t pll_Hz() const {
    const std::uint32_t p = rcc.PLLCFGR.stored();
    const std::uint32_t input = (p & rcc::kPllFromCrystal) != 0 ? 8'000'000 : 16'000'000;
    return input / (p & 0x3F) * (p >> 6 & 0x1FF) / (2 * ((p >> 16 & 3) + 1));
  }
  std::uint32_t running() const { return rcc.CFGR.stored() >> 2 & 3; }
  Clocks start() { return start_clocks(rcc, pwr, flash); }
};

}  // namespace

TEST_CASE("clocks: crystal and PLL give 168 MHz, and the crystal is watched") {
  SimulatedClocks sim;
  const Clocks clocks = sim.start();
  CHECK(clocks.source == ClockSource::kCrystalPll);
  CHECK(clocks.core_Hz == 168'000'000);
  CHECK(sim.pll_Hz() == 168'000'000);
  CHECK(sim.running() == 2);
  CHECK((sim.rcc.CFGR.stored() >> 10 & 7) == 5);  // APB1 by 4: 42 MHz
  CHECK((sim.rcc.CFGR.stored() >> 13 & 7) == 4);  // APB2 by 2: 84 MHz
  CHECK(clocks.apb1_Hz == 42'000'000);
  CHECK(clocks.apb2_Hz == 84'000'000);
  CHECK((sim.rcc.CR.stored() & rcc::kCrystalWatched) != 0);
  CHECK_FALSE(sim.fast_core_on_fast_flash);
  CHECK((sim.pwr.CR.stored() & pwr::kFullVoltage) != 0);
  CHECK(can_bit_timing(clocks) == 0x011A'0002u);
}

TEST_CASE("clocks: without crystal the internal oscillator and the PLL, and no CAN") {
  SimulatedClocks sim;
  sim.crystal_works = false;
  const Clocks clocks = sim.start();
  CHECK(clocks.source == ClockSource::kInternalPll);
  CHECK(clocks.core_Hz == 168'000'000);
  CHECK(sim.pll_Hz() == 168'000'000);
  CHECK(sim.running() == 2);
  CHECK((sim.rcc.CR.stored() & (rcc::kCrystalOn | rcc::kCrystalWatched)) == 0);
  CHECK_FALSE(sim.fast_core_on_fast_flash);
  CHECK_FALSE(can_bit_timing(clocks).has_value());
  CHECK(sim.access.accesses < 1'000'000);
}

TEST_CASE("clocks: a PLL that fails on the crystal is tried on the internal oscillator") {
  SimulatedClocks sim;
  sim.access.when_read(sim.rcc.PLLCFGR, [](hal::Register& r) { return r.stored(); });
  int locks = 0;
  sim.access.when_written(sim.rcc.CR, [&](hal::Register& r, std::uint32_t value) {
    const bool crystal = (sim.rcc.PLLCFGR.stored() & rcc::kPllFromCrystal) != 0;
    value = (value & rcc::kCrystalOn) != 0 ? value | rcc::kCrystalReady : value;
    value &= ~rcc::kPllReady;
    if ((value & rcc::kPllOn) != 0 && !crystal && ++locks > 0) value |= rcc::kPllReady;
    r.store(value);
  });
  CHECK(sim.start().source == ClockSource::kInternalPll);
  CHECK(sim.running() == 2);
}

TEST_CASE("clocks: where nothing works, 16 MHz as after reset, after a bounded number of looks") {
  SimulatedClocks sim;
  const auto broken = GENERATE(0, 1, 2);
  CAPTURE(broken);
  if (broken == 0) sim.locks_that_work = 0;
  if (broken == 1) sim.switch_works = false;
  if (broken == 2) sim.access.when_written(sim.flash.ACR, [](hal::Register&, std::uint32_t) {});
  const Clocks clocks = sim.start();
  CHECK(clocks.source == ClockSource::kInternal);
  CHECK(clocks.core_Hz == 16'000'000);
  CHECK(clocks.apb1_Hz == 16'000'000);
  CHECK(clocks.apb2_Hz == 16'000'000);
  CHECK(sim.running() == 0);
  CHECK((sim.rcc.CFGR.stored() & 0xFCF0) == 0);  // no divider
  CHECK((sim.rcc.CR.stored() & rcc::kPllOn) == 0);
  CHECK_FALSE(sim.fast_core_on_fast_flash);
  CHECK_FALSE(can_bit_timing(clocks).has_value());
  CHECK(sim.access.accesses < 1'000'000);
}

TEST_CASE("clocks: registers that read zero, as in an emulator without them, end as 16 MHz") {
  SimulatedClocks sim;
  for (hal::Register* each : {&sim.rcc.CR, &sim.rcc.CFGR, &sim.rcc.PLLCFGR, &sim.flash.ACR}) {
    sim.access.when_written(*each, [](hal::Register&, std::uint32_t) {});
    sim.access.when_read(*each, [](hal::Register&) { return 0u; });
  }
  CHECK(sim.start().source == ClockSource::kInternal);
  CHECK(sim.access.accesses < 1'000'000);
}
