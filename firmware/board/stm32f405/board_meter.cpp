#include "firmware/board/stm32f405/board_meter.h"

namespace hoof::firmware::stm32f405 {
namespace {

/// Less than a tick, so that each tick has a value of its own where the loop comes round a little
/// earlier than a millisecond after the last time.
constexpr std::int64_t kPeriod_ns = 900'000;

/// So many periods without an answer: the converter has failed. Three conversions take 70 us at
/// 21 MHz (84 MHz by 4; 36 MHz are allowed), 0.4 ms at 4 MHz.
constexpr std::uint32_t kMostLooks = 5;

constexpr std::uint32_t kSupplyChannel = 10;  // PC0
constexpr float kFullScale = 4095.0f;
constexpr float kFactory_V = 3.3f;

// 1.18 to 1.24 V (DS8626, embedded internal reference), at a board of 2.7 to 3.6 V.
constexpr float kLowestReference = 1.18f / 3.6f * kFullScale;
constexpr float kHighestReference = 1.24f / 2.7f * kFullScale;
// The same at the factory's 3.3 V; outside, the part has none.
constexpr std::uint32_t kLowestFactory = 1464, kHighestFactory = 1539;
constexpr float kTypicalFactory = 1.21f / kFactory_V * kFullScale;

}  // namespace

/// 480 cycles of sampling are 22.9 us: the temperature sensor needs 10 (DS8626), the divider's
/// 9.5 kOhm less.
void BoardMeter::start() {
  common_.CCR.write(adc::kClockBy4 | adc::kInsideOn);
  adc_.SMPR[0].write(adc::sampling(kSupplyChannel, adc::k480Cycles) |
                     adc::sampling(adc::kTemperature, adc::k480Cycles) |
                     adc::sampling(adc::kReference, adc::k480Cycles));
  adc_.JSQR.write(adc::injected(kSupplyChannel, adc::kReference, adc::kTemperature));
  adc_.CR1.write(adc::kScan);
  adc_.CR2.write(adc::kOn);
}

void BoardMeter::maintain(std::int64_t now_ns) {
  if (now_ns < due_ns_) return;
  const bool first = due_ns_ == 0;
  due_ns_ = now_ns + kPeriod_ns;
  if (first) return;  // converter and sensor need 10 us at most after start()
  if (converting_ && !adc_.SR.has(adc::kInjectedEnd)) {
    if (++looks_ < kMostLooks) return;
    find_no_answer();
  } else if (converting_) {
    take();
  }
  looks_ = 0;
  converting_ = true;
  adc_.SR.write(~adc::kInjectedEnd);
  adc_.CR2.write(adc::kOn | adc::kStartInjected);
}

/// Only here is the factory's memory read: whoever has no such memory, as QEMU, has no converter
/// that comes to an end either.
void BoardMeter::take() {
  const auto reference = static_cast<float>(adc_.JDR[1].read());
  if (reference < kLowestReference || reference > kHighestReference) return find_no_answer();
  const std::uint32_t factory = factory_.reference;
  const bool known = factory >= kLowestFactory && factory <= kHighestFactory;
  // What the factory would have read at its 3.3 V is this times what is read here.
  const float ratio = (known ? static_cast<float>(factory) : kTypicalFactory) / reference;
  const float pin_V = static_cast<float>(adc_.JDR[0].read()) * ratio * (kFactory_V / kFullScale);
  const float supply_V = pin_V * kDivider;
  wired_ = wired_ || supply_V >= kWired_V;
  supply_V_ = !wired_ ? 0.0f : supply_V < kLeast_V ? kLeast_V : supply_V;
  take_temperature(static_cast<float>(adc_.JDR[2].read()), ratio);
}

void BoardMeter::take_temperature(float raw, float ratio) {
  const auto at_30C = static_cast<float>(factory_.temperature_30C);
  const auto at_110C = static_cast<float>(factory_.temperature_110C);
  const bool known = at_30C > 0.0f && at_110C > at_30C && at_110C < kFullScale;
  temperature_C_ = known ? 30.0f + (110.0f - 30.0f) * (raw * ratio - at_30C) / (at_110C - at_30C)
                         : std::numeric_limits<float>::quiet_NaN();
}

/// A measurement that was there and is no more is a doubt, and any doubt stops.
void BoardMeter::find_no_answer() {
  supply_V_ = wired_ ? kLeast_V : 0.0f;
  temperature_C_ = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace hoof::firmware::stm32f405
