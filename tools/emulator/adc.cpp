#include "tools/emulator/adc.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kStatus = 0x00,
  kControl1 = 0x04,
  kControl2 = 0x08,
  kSampling = 0x0C,  // two
  kInjected = 0x38,
  kInjectedData = 0x3C,  // four
  kCommonControl = 0x304
};

constexpr std::uint32_t kInjectedEnd = 1u << 2, kInjectedStarted = 1u << 3;
constexpr std::uint32_t kFlags = 0x3F;
constexpr std::uint32_t kScan = 1u << 8;
constexpr std::uint32_t kOn = 1u << 0, kStartInjected = 1u << 22;
constexpr std::uint32_t kInsideOn = 1u << 23;
constexpr std::uint32_t kTemperatureChannel = 16, kReferenceChannel = 17, kSupplyChannel = 10;

constexpr double kFullScale = 4095, kFactory_V = 3.3;
constexpr double kDivider = 19;         // 180 kOhm above 10 kOhm, by the board's README
constexpr double kReference_V = 1.195;  // of this part; 1.21 as a rule
constexpr Cycles kStartTime = 3 * kCyclesPerMicrosecond;

/// Of this part, at 25 C a little more than the usual 0.76 V.
double sensor_V(double temperature_C) {
  return 0.773 + 0.0025 * (temperature_C - 25);
}

std::uint32_t counts(double volts, double full_V) {
  return std::uint32_t(std::lround(std::clamp(volts / full_V, 0.0, 1.0) * kFullScale));
}

}  // namespace

std::array<std::uint16_t, 3> Adc::factory_calibration() {
  const auto at = [](double volts) { return std::uint16_t(counts(volts, kFactory_V)); };
  return {at(kReference_V), at(sensor_V(30)), at(sensor_V(110))};
}

void Adc::reset() {
  status_ = control1_ = control2_ = sequence_ = common_ = 0;
  sampling_ = {};
  data_ = {};
  converting_ = false;
}

/// The last of JSQ4 comes last, whatever their number (RM0090, 13.13.12).
std::uint32_t Adc::channel(std::uint32_t conversion) const {
  const std::uint32_t place = 4 - conversions() + conversion;
  return sequence_ >> (5 * place) & 0x1F;
}

std::uint32_t Adc::counts_of(std::uint32_t channel) const {
  switch (channel) {
    case kSupplyChannel:
      if (!analog_(channel)) throw EmulatorError("ADC1: the pin of channel 10 is not analog");
      return counts(at_.supply_V / kDivider, at_.analog_V);
    case kTemperatureChannel:
    case kReferenceChannel:
      if ((common_ & kInsideOn) == 0) throw EmulatorError("ADC1: sensor and reference are off");
      return counts(channel == kReferenceChannel ? kReference_V : sensor_V(at_.temperature_C),
                    at_.analog_V);
    default:
      throw EmulatorError("ADC1: nothing is at channel " + std::to_string(channel));
  }
}

/// Sampling and 12 cycles for 12 bits, each conversion.
Cycles Adc::duration() const {
  constexpr std::array<std::uint32_t, 8> kSamplingCycles = {3, 15, 28, 56, 84, 112, 144, 480};
  std::uint32_t cycles = 0;
  for (std::uint32_t i = 0; i < conversions(); ++i) {
    const std::uint32_t c = channel(i);
    cycles += 12 + kSamplingCycles[sampling_[c < 10 ? 1 : 0] >> (3 * (c % 10)) & 7];
  }
  const std::uint32_t prescaler = 2 * ((common_ >> 16 & 3) + 1);
  return Cycles(cycles) * prescaler * 168 / clock_MHz_();
}

void Adc::start_injected() {
  if ((control2_ & kOn) == 0) throw EmulatorError("ADC1: started while it is off");
  if (time_.now < on_since_ + kStartTime) {
    throw EmulatorError("ADC1: started less than 3 us after it was switched on");
  }
  if (clock_MHz_() > 36 * 2 * ((common_ >> 16 & 3) + 1)) {
    throw EmulatorError("ADC1: its clock is beyond 36 MHz");
  }
  if (conversions() > 1 && (control1_ & kScan) == 0) {
    throw EmulatorError("ADC1: several conversions without scan mode");
  }
  converting_ = !dead_;
  status_ |= kInjectedStarted;
  ready_ = time_.now + duration();
}

void Adc::set_voltages(const BoardVoltages& voltages) {
  convert();  // what has ended saw the former ones
  at_ = voltages;
}

/// The voltages are taken at the end: in the time of a conversion they do not change here.
void Adc::convert() {
  if (!converting_ || time_.now < ready_) return;
  converting_ = false;
  for (std::uint32_t i = 0; i < conversions(); ++i) data_[i] = counts_of(channel(i));
  status_ |= kInjectedEnd;
}

std::uint32_t Adc::read(std::uint32_t offset) {
  convert();
  if (offset >= kInjectedData && offset < kInjectedData + 16) {
    return data_[(offset - kInjectedData) / 4];
  }
  switch (offset) {
    case kStatus:
      return status_;
    case kControl1:
      return control1_;
    case kControl2:
      return control2_;
    case kSampling:
    case kSampling + 4:
      return sampling_[(offset - kSampling) / 4];
    case kInjected:
      return sequence_;
    case kCommonControl:
      return common_;
    default:
      no_such_register(offset);
  }
}

void Adc::write(std::uint32_t offset, std::uint32_t value) {
  convert();
  switch (offset) {
    case kStatus:
      status_ &= value | ~kFlags;
      return;
    case kControl1:
      if ((value & ~kScan) != 0) throw EmulatorError("ADC1 has no model of CR1 = " + hex(value));
      control1_ = value;
      return;
    case kControl2:
      if ((value & ~(kOn | kStartInjected)) != 0) {
        throw EmulatorError("ADC1 has no model of CR2 = " + hex(value));
      }
      if ((value & kOn) != 0 && (control2_ & kOn) == 0) on_since_ = time_.now;
      control2_ = value & kOn;
      if ((value & kStartInjected) != 0) start_injected();
      return;
    case kSampling:
    case kSampling + 4:
      sampling_[(offset - kSampling) / 4] = value;
      return;
    case kInjected:
      sequence_ = value & 0x3F'FFFF;
      return;
    case kCommonControl:
      if ((value & ~(kInsideOn | 3u << 16)) != 0) {
        throw EmulatorError("ADC1 has no model of CCR = " + hex(value));
      }
      common_ = value;
      return;
    default:
      no_such_register(offset);
  }
}

}  // namespace hoof::tools::emulator
