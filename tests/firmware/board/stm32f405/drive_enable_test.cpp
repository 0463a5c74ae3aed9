// The drives' line over a simulated timer, whose break acts on the level of its input.
#include "firmware/board/stm32f405/drive_enable.h"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;

namespace {

constexpr std::uint32_t kOn = 1u << 15, kFlag = 1u << 7;

struct Rig {
  tests::SimulatedRegisters access;
  TimerRegisters timer;
  DriveEnable enable{timer};
  bool pressed = false;
  bool locked = false;

  Rig() {
    access.when_written(timer.BDTR, [this](hal::Register& r, std::uint32_t value) {
      const std::uint32_t kept = locked ? 0x7FFFu : 0u;
      locked = true;
      r.store((value & ~kept) | (r.stored() & kept));
      act();
    });
    access.when_written(timer.SR, [this](hal::Register& r, std::uint32_t value) {
      r.store(r.stored() & value);
      act();
    });
  }
  void act() {
    if (!pressed || (timer.BDTR.stored() & 1u << 12) == 0) return;
    timer.BDTR.store(timer.BDTR.stored() & ~kOn);
    timer.SR.store(timer.SR.stored() | kFlag);
  }
  void press(bool now) {
    pressed = now;
    act();
  }
  bool on() const { return (timer.BDTR.stored() & kOn) != 0; }
  bool interrupts() const { return (timer.SR.stored() & timer.DIER.stored() & kFlag) != 0; }
};

}  // namespace

TEST_CASE("drives' line: 12.5 kHz from each clock there is, off at first, everything locked") {
  for (const std::uint32_t clock_Hz : {168'000'000u, 16'000'000u}) {
    CAPTURE(clock_Hz);
    Rig rig;
    rig.enable.start(clock_Hz);
    const std::uint32_t period = (rig.timer.PSC.stored() + 1) * (rig.timer.ARR.stored() + 1);
    CHECK(clock_Hz / period == 12'500);
    CHECK(clock_Hz % period == 0);
    CHECK(2 * rig.timer.CCR[0].stored() == rig.timer.ARR.stored() + 1);  // half of it high
    CHECK((rig.timer.CCMR[0].stored() & 0x73) == 0x60);                  // output, PWM mode 1
    CHECK(rig.timer.CCER.stored() == 1);                                 // active high
    CHECK(rig.timer.CR2.stored() == 0);                                  // OIS1: low without MOE
    // BKE, OSSI, LOCK 3; not AOE, not MOE, the break active low.
    CHECK(rig.timer.BDTR.stored() == 0x1700);
    CHECK((rig.timer.CR1.stored() & 1) == 1);
    CHECK_FALSE(rig.on());
  }
}

TEST_CASE("drives' line: prescaler and modes are there before the lock") {
  Rig rig;
  std::vector<std::string> order;
  const auto note = [&](hal::Register& target, const char* name) {
    rig.access.when_written(target, [&order, name](hal::Register& r, std::uint32_t value) {
      order.emplace_back(name);
      r.store(value);
    });
  };
  note(rig.timer.PSC, "PSC");
  note(rig.timer.CCMR[0], "CCMR1");
  note(rig.timer.CCER, "CCER");
  note(rig.timer.EGR, "EGR");
  note(rig.timer.BDTR, "BDTR");
  rig.enable.start(168'000'000);
  CHECK(order == std::vector<std::string>{"PSC", "CCMR1", "CCER", "EGR", "BDTR"});
}

TEST_CASE("drives' line: a break takes it away, and only a stop that was seen gives it back") {
  Rig rig;
  rig.enable.start(168'000'000);
  rig.enable.allow(true);
  CHECK(rig.on());
  rig.press(true);
  CHECK_FALSE(rig.on());
  CHECK(rig.enable.broken());
  CHECK(rig.interrupts());
  rig.enable.on_break_interrupt();
  CHECK_FALSE(rig.interrupts());  // else it would come again and again
  rig.enable.allow(true);
  CHECK_FALSE(rig.on());
  rig.enable.allow(false);
  CHECK(rig.enable.broken());  // the loop is still open
  CHECK_FALSE(rig.interrupts());
  rig.press(false);
  CHECK(rig.enable.broken());
  rig.enable.allow(true);  // not seen since: not forgotten
  CHECK_FALSE(rig.on());
  rig.enable.allow(false);
  CHECK_FALSE(rig.enable.broken());
  CHECK_FALSE(rig.on());
  rig.enable.allow(true);
  CHECK(rig.on());
  rig.press(true);  // the interrupt is armed again
  CHECK(rig.interrupts());
}

TEST_CASE("drives' line: a press shorter than a turn of the loop") {
  Rig rig;
  rig.enable.start(168'000'000);
  rig.enable.allow(true);
  rig.press(true);
  rig.press(false);
  CHECK_FALSE(rig.on());
  CHECK(rig.enable.broken());
  rig.enable.allow(true);
  CHECK_FALSE(rig.on());
}

TEST_CASE("drives' line: a button that is pressed at the start, and a stop without a button") {
  Rig rig;
  rig.press(true);
  rig.enable.start(168'000'000);
  CHECK(rig.enable.broken());
  rig.enable.allow(true);
  CHECK_FALSE(rig.on());
  rig.press(false);
  rig.enable.allow(false);
  rig.enable.allow(true);
  CHECK(rig.on());
  rig.enable.allow(false);  // an e-stop frame
  CHECK_FALSE(rig.on());
  CHECK_FALSE(rig.enable.broken());
}

TEST_CASE("drives' line: allowed all the time it costs no access") {
  Rig rig;
  rig.enable.start(168'000'000);
  rig.enable.allow(true);
  rig.access.accesses = 0;
  for (int i = 0; i < 10; ++i) rig.enable.allow(true);
  CHECK(rig.access.accesses == 0);
}
