// Supply and temperature over a simulated converter with voltages at its pins.
#include "firmware/board/stm32f405/board_meter.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "tests/firmware/board/stm32f405/simulated_registers.h"

using namespace hoof;
using namespace hoof::firmware::stm32f405;

namespace {

constexpr std::int64_t kTick_ns = 1'000'000;

/// Reference 1.22 V, sensor of 0.77 V at 30 C and 2.6 mV/C; the factory measured them at 3.3 V.
struct Rig {
  tests::SimulatedRegisters access;
  AdcRegisters adc;
  AdcCommonRegisters common;
  FactoryCalibration factory{counts(1.22, 3.3), counts(0.77, 3.3), counts(0.77 + 0.0026 * 80, 3.3)};
  BoardMeter meter{adc, common, factory};
  double supply_V = 48, board_V = 3.3, temperature_C = 40, reference_V = 1.22;
  std::int64_t now_ns = kTick_ns;
  int conversions = 0;
  bool answers = true;
  std::optional<std::int64_t> ready_ns;

  static std::uint16_t counts(double volts, double full_V) {
    return std::uint16_t(std::lround(std::clamp(volts / full_V, 0.0, 1.0) * 4095));
  }

  Rig() {
    access.when_written(adc.CR2, [this](hal::Register& r, std::uint32_t value) {
      r.store(value & 1);
      if ((value & 1u << 22) == 0) return;
      CHECK((value & 1) == 1);
      CHECK((adc.SR.stored() & 4) == 0);
      ++conversions;
      ready_ns = now_ns + 70'000;
    });
    access.when_read(adc.SR, [this](hal::Register& r) {
      if (answers && ready_ns && now_ns >= *ready_ns) convert();
      return r.stored();
    });
    access.when_written(adc.SR,
                        [](hal::Register& r, std::uint32_t value) { r.store(r.stored() & value); });
    meter.start();
  }
  void convert() {
    ready_ns.reset();
    adc.JDR[0].store(counts(supply_V / 19, board_V));
    adc.JDR[1].store(counts(reference_V, board_V));
    adc.JDR[2].store(counts(0.77 + 0.0026 * (temperature_C - 30), board_V));
    adc.SR.store(adc.SR.stored() | 4);
  }
  /// The main loop comes round three times in each of them.
  void run_ms(int ms) {
    for (int i = 0; i < 3 * ms; ++i) {
      meter.maintain(now_ns);
      now_ns += kTick_ns / 3;
    }
  }
};

// A step of the converter is 3.3 V / 4095 * 19 = 15 mV; half of one at the supply, and the same
// share, half of 1514, at the reference: 0.03 % of 48 V.
constexpr double kStep_V = 0.030;
// Half a step each of sensor and calibration, of 0.31 C, the latter drawn out to 40 C.
constexpr double kStep_C = 0.5;

}  // namespace

TEST_CASE("meter: supply, reference and sensor in this order, long enough sampled") {
  Rig rig;
  CHECK(rig.common.CCR.stored() == (1u << 16 | 1u << 23));  // APB2 by 4; sensor and reference on
  CHECK(rig.adc.CR1.stored() == 1u << 8);
  CHECK(rig.adc.CR2.stored() == 1);
  const std::uint32_t sequence = rig.adc.JSQR.stored();
  CHECK((sequence >> 20 & 3) == 2);
  CHECK((sequence >> 5 & 31) == 10);
  CHECK((sequence >> 10 & 31) == 17);
  CHECK((sequence >> 15 & 31) == 16);
  for (const unsigned channel : {10u, 16u, 17u}) {
    CHECK((rig.adc.SMPR[0].stored() >> (3 * (channel - 10)) & 7) == 7);
  }
}

TEST_CASE("meter: supply and temperature, whatever the board's own 3.3 V are") {
  const double board_V = GENERATE(3.0, 3.3, 3.6);
  const double supply_V = GENERATE(24.0, 36.0, 48.0, 56.9);
  const double temperature_C = GENERATE(-20.0, 30.0, 110.0);
  CAPTURE(board_V, supply_V, temperature_C);
  Rig rig;
  rig.board_V = board_V;
  rig.supply_V = supply_V;
  rig.temperature_C = temperature_C;
  CHECK(rig.meter.supply_V() == 0.0f);
  CHECK(std::isnan(rig.meter.temperature_C()));
  rig.run_ms(4);
  CHECK(rig.meter.supply_V() == Approx(supply_V).margin(kStep_V));
  CHECK(rig.meter.temperature_C() == Approx(temperature_C).margin(1.2 * kStep_C));
}

TEST_CASE("meter: a value a millisecond, at most two old, and no register between") {
  Rig rig;
  rig.run_ms(3);
  const int before = rig.conversions;
  for (int i = 0; i < 300; ++i) {
    rig.supply_V = 40 + 0.05 * (i % 100);
    const double last_V = 40 + 0.05 * ((i + 98) % 100), now_V = rig.supply_V;
    rig.run_ms(1);
    if (i % 100 >= 2) {
      REQUIRE(rig.meter.supply_V() >= last_V - kStep_V);
      REQUIRE(rig.meter.supply_V() <= now_V + kStep_V);
    }
  }
  CHECK(rig.conversions == before + 300);
  rig.access.accesses = 0;
  rig.meter.maintain(rig.now_ns);
  const std::size_t one = rig.access.accesses;
  CHECK(one <= 8);  // 2 of status, 3 of data, 1 to start
  for (int i = 0; i < 100; ++i) rig.meter.maintain(rig.now_ns);
  CHECK(rig.access.accesses == one);
}

TEST_CASE("meter: nothing but ground at the pin is not measured; a supply that is gone is low") {
  Rig rig;
  rig.supply_V = 0;
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == 0.0f);
  CHECK(rig.meter.temperature_C() == Approx(40).margin(kStep_C));
  rig.supply_V = BoardMeter::kWired_V - 0.1;
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == 0.0f);
  rig.supply_V = 48;
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == Approx(48).margin(kStep_V));
  rig.supply_V = 1;
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == Approx(1).margin(kStep_V));
  rig.supply_V = 0;  // the wire is cut: not "not measured"
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == 0.25f);
}

TEST_CASE("meter: a converter that no longer answers, or without its reference, is a low supply") {
  const bool reference = GENERATE(false, true);
  CAPTURE(reference);
  Rig rig;
  rig.run_ms(5);
  (reference ? rig.reference_V : rig.supply_V) = reference ? 0 : 48;
  rig.answers = reference;
  rig.run_ms(8);
  CHECK(rig.meter.supply_V() == BoardMeter::kLeast_V);
  CHECK(std::isnan(rig.meter.temperature_C()));
  // It is asked again, and may come back.
  rig.reference_V = 1.22;
  rig.answers = true;
  rig.run_ms(8);
  CHECK(rig.meter.supply_V() == Approx(48).margin(kStep_V));
}

TEST_CASE(
    "meter: where no converter ever answers nothing is measured, nor the factory's memory read") {
  Rig rig;
  rig.answers = false;
  rig.run_ms(100);
  CHECK(rig.meter.supply_V() == 0.0f);
  CHECK(std::isnan(rig.meter.temperature_C()));
  CHECK(rig.access.accesses < 400);  // it never waits
}

TEST_CASE("meter: a part without calibration measures the supply to 2.5 %, and no temperature") {
  Rig rig;
  rig.factory.reference = 0xFFFF;
  rig.factory.temperature_30C = 0xFFFF;
  rig.factory.temperature_110C = 0xFFFF;
  rig.run_ms(5);
  CHECK(rig.meter.supply_V() == Approx(48.0 * 1.21 / 1.22).margin(kStep_V));
  CHECK(std::isnan(rig.meter.temperature_C()));
}
