#include "firmware/board/stm32f405/system_clock.h"

#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;

namespace {

/// SysTick with a core that needs time for every access, and takes the interrupt where it may.
class SimulatedTick {
  tests::SimulatedRegisters access_;
  SysTickRegisters systick_;
  ScbRegisters scb_;

 public:
  SystemClock clock;

  explicit SimulatedTick(std::uint32_t core_Hz, std::uint64_t first_ms = 0)
      : clock(systick_, scb_, first_ms), cycles_per_ms_(core_Hz / 1000) {
    access_.when_read(systick_.CVR, [this](hal::Register&) {
      spend();
      return counter();
    });
    access_.when_read(scb_.ICSR, [this](hal::Register&) {
      spend();
      return pending_ ? scb::kPendingTick : 0;
    });
    access_.when_written(scb_.ICSR, [this](hal::Register&, std::uint32_t value) {
      if ((value & scb::kClearPendingTick) != 0) pending_ = false;
    });
    clock.start(core_Hz);
    CHECK(systick_.RVR.stored() == cycles_per_ms_ - 1);
  }

  std::function<std::uint32_t()> access_cost = [] { return 4u; };
  bool masked = false;

  void pass(std::uint64_t cycles) {
    for (; cycles > cycles_per_ms_; cycles -= cycles_per_ms_) pass(cycles_per_ms_);
    const std::uint64_t before = cycle_ / cycles_per_ms_;
    cycle_ += cycles;
    if (cycle_ / cycles_per_ms_ != before) pending_ = true;
    serve();
  }
  void serve() {
    if (!pending_ || masked) return;
    pending_ = false;
    clock.on_tick();
  }
  std::int64_t true_ns() const {
    return static_cast<std::int64_t>(cycle_ * 1'000'000 / cycles_per_ms_);
  }

 private:
  /// RVR at the first cycle after zero, 0 at the cycle that raises the tick.
  std::uint32_t counter() const {
    const auto phase = static_cast<std::uint32_t>(cycle_ % cycles_per_ms_);
    return phase == 0 ? 0 : cycles_per_ms_ - phase;
  }
  void spend() { pass(access_cost()); }

  std::uint32_t cycles_per_ms_;
  std::uint64_t cycle_ = 0;
  bool pending_ = false;
};

}  // namespace

TEST_CASE("clock: every cycle around a tick reads as the time it is") {
  const std::uint32_t core_Hz = GENERATE(168'000'000u, 16'000'000u);
  const bool masked = GENERATE(false, true);
  CAPTURE(core_Hz, masked);
  SimulatedTick sim(core_Hz);
  sim.access_cost = [] { return 0u; };
  const std::uint32_t per_ms = core_Hz / 1000;
  sim.pass(3 * per_ms - 200);
  sim.masked = masked;
  for (int i = 0; i < 400; ++i) {
    CAPTURE(i);
    // A cycle is 6 or 62.5 ns; what is left is rounding to whole ones.
    REQUIRE(sim.clock.now_ns() == sim.true_ns());
    sim.pass(1);
  }
}

TEST_CASE("clock: random readings never go back and lie between begin and end of the reading") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  std::mt19937 random(seed);
  SimulatedTick sim(168'000'000);
  sim.access_cost = [&] {
    // Other interrupts may take long; masked, a reading takes its own few cycles.
    return !sim.masked && random() % 64 == 0 ? random() % 60'000 : random() % 12;
  };
  std::int64_t last = 0;
  for (int i = 0; i < 200'000; ++i) {
    sim.pass(random() % 8 == 0 ? 168'000 - random() % 40 : random() % 100'000);
    sim.masked = random() % 2 == 0;  // in an interrupt of the tick's own priority, for microseconds
    sim.pass(random() % 2'000);
    const std::int64_t before = sim.true_ns();
    const std::int64_t read = sim.clock.now_ns();
    const std::int64_t after = sim.true_ns();
    CAPTURE(i, before, after);
    REQUIRE(read >= before);
    REQUIRE(read <= after);
    REQUIRE(read >= last);
    last = read;
    sim.masked = false;
    sim.serve();
  }
}

TEST_CASE("clock: a stamp changes with each cycle and at the same place of each millisecond") {
  SimulatedTick sim(168'000'000);
  sim.access_cost = [] { return 0u; };
  std::uint32_t last = sim.clock.stamp();
  CHECK(sim.clock.stamp() == last);  // nothing has passed
  for (int i = 0; i < 1'000; ++i) {
    sim.pass(i % 2 == 0 ? 1 : 168'000);
    CAPTURE(i);
    REQUIRE(sim.clock.stamp() != last);
    last = sim.clock.stamp();
  }
}

TEST_CASE("clock: the millisecond count passes 2^32, after 49 days") {
  const std::uint64_t first_ms = (1ull << 32) - 3;
  SimulatedTick sim(16'000'000, first_ms);
  for (int i = 0; i < 100'000; ++i) {
    const std::int64_t before = sim.true_ns();
    const std::int64_t read = sim.clock.now_ns() - static_cast<std::int64_t>(first_ms) * 1'000'000;
    REQUIRE(read >= before);
    REQUIRE(read <= sim.true_ns());
  }
  CHECK(sim.true_ns() > 20'000'000);
}

TEST_CASE("clock: ticks taken with interrupts masked count as those of the interrupt") {
  SimulatedTick sim(168'000'000);
  sim.access_cost = [] { return 20u; };
  sim.masked = true;
  int taken = 0;
  while (sim.true_ns() < 500'000'000) taken += sim.clock.take_pending_tick() ? 1 : 0;
  CHECK(taken == 500);
  sim.access_cost = [] { return 0u; };
  CHECK(sim.clock.now_ns() == sim.true_ns());
}
