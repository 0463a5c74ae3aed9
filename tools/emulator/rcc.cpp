#include "tools/emulator/rcc.h"

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kControl = 0x00,
  kPll = 0x04,
  kConfiguration = 0x08,
  kAhb1 = 0x30,
  kApb1 = 0x40,
  kApb2 = 0x44,
  kStatus = 0x74
};

constexpr std::uint32_t kInternal = 1u << 0, kInternalReady = 1u << 1;
constexpr std::uint32_t kCrystal = 1u << 16, kCrystalReady = 1u << 17;
constexpr std::uint32_t kCrystalWatched = 1u << 19;
constexpr std::uint32_t kPllOn = 1u << 24, kPllReady = 1u << 25;
constexpr std::uint32_t kWritable = 1u << 24 | 0xDu << 16 | 0xF9u;
constexpr std::uint32_t kPllFromCrystal = 1u << 22;
constexpr std::uint32_t kInternal_MHz = 16, kCrystal_MHz = 8;

/// Looks at a clock before it is there: more than one, so that an image that does not wait is seen.
constexpr int kCrystalLooks = 100;
constexpr int kPllLooks = 20;

constexpr std::uint32_t kClearFlags = 1u << 24;
constexpr std::uint32_t kBrownOut = 1u << 25, kPin = 1u << 26, kPowerOn = 1u << 27,
                        kSoftware = 1u << 28, kIndependentWatchdog = 1u << 29;

}  // namespace

void Rcc::reset() {
  control_ = kInternal | kInternalReady;
  pll_ = 0x2400'3010;
  configuration_ = 0;
  ahb1_ = 0x0010'0000;
  apb1_ = apb2_ = 0;
  core_MHz_ = kInternal_MHz;
  on_core_clock_(core_MHz_);
}

/// Each reset also pulls the reset pin; power-on also counts as a brown-out (RM0090, 7.3.21).
void Rcc::note_reset(hal::ResetCause cause) {
  switch (cause) {
    case hal::ResetCause::kPowerOn:
      status_ = kPowerOn | kBrownOut | kPin;
      return;
    case hal::ResetCause::kBrownOut:
      status_ |= kBrownOut | kPin;
      return;
    case hal::ResetCause::kWatchdog:
      status_ |= kIndependentWatchdog | kPin;
      return;
    case hal::ResetCause::kSoftware:
    case hal::ResetCause::kRequested:  // the part does not tell one from the other
      status_ |= kSoftware | kPin;
      return;
    case hal::ResetCause::kPin:
      status_ |= kPin;
      return;
  }
}

std::uint32_t Rcc::clock_control() {
  if ((control_ & kCrystal) != 0 && (control_ & kCrystalReady) == 0 && !faults_.crystal_dead &&
      --crystal_looks_ <= 0) {
    control_ |= kCrystalReady;
  }
  const bool source = (pll_ & kPllFromCrystal) == 0 || (control_ & kCrystalReady) != 0;
  if ((control_ & kPllOn) != 0 && (control_ & kPllReady) == 0 && !faults_.pll_dead && source &&
      --pll_looks_ <= 0) {
    control_ |= kPllReady;
  }
  return control_;
}

void Rcc::write_clock_control(std::uint32_t value) {
  if ((value & kCrystal) != 0 && (control_ & kCrystal) == 0) crystal_looks_ = kCrystalLooks;
  if ((value & kPllOn) != 0 && (control_ & kPllOn) == 0) pll_looks_ = kPllLooks;
  std::uint32_t ready = control_ & (kInternalReady | kCrystalReady | kPllReady);
  if ((value & kCrystal) == 0) ready &= ~kCrystalReady;
  if ((value & kPllOn) == 0) ready &= ~kPllReady;
  control_ = (value & kWritable) | ready;
}

bool Rcc::from_crystal() const {
  return (configuration_ & 3) == 1 || ((configuration_ & 3) == 2 && (pll_ & kPllFromCrystal) != 0);
}

std::uint32_t Rcc::pll_MHz() const {
  const std::uint32_t m = pll_ & 0x3F, n = pll_ >> 6 & 0x1FF, p = 2 * ((pll_ >> 16 & 3) + 1);
  if (m < 2 || n < 50) throw EmulatorError("RCC: PLLCFGR " + hex(pll_) + " is not allowed");
  const std::uint32_t source = (pll_ & kPllFromCrystal) != 0 ? kCrystal_MHz : kInternal_MHz;
  return source * n / m / p;
}

void Rcc::switch_clock() {
  std::uint32_t megahertz = kInternal_MHz;
  switch (configuration_ & 3) {
    case 0:
      break;
    case 1:
      megahertz = kCrystal_MHz;
      break;
    case 2:
      if ((control_ & kPllReady) == 0)
        throw EmulatorError("RCC: switched to a PLL that is not locked");
      megahertz = pll_MHz();
      break;
    default:
      throw EmulatorError("RCC: clock source 3 is not there");
  }
  if (megahertz != 168 && megahertz != 16 && megahertz != 8) {
    throw EmulatorError("RCC: no model of a core at " + std::to_string(megahertz) + " MHz");
  }
  if (megahertz == core_MHz_) return;
  core_MHz_ = megahertz;
  on_core_clock_(core_MHz_);
}

std::uint32_t Rcc::apb1_MHz() const {
  const std::uint32_t divider = configuration_ >> 10 & 7;
  return divider < 4 ? core_MHz_ : core_MHz_ >> (divider - 3);
}

std::uint32_t Rcc::apb2_MHz() const {
  const std::uint32_t divider = configuration_ >> 13 & 7;
  return divider < 4 ? core_MHz_ : core_MHz_ >> (divider - 3);
}

std::uint32_t Rcc::timer2_MHz() const {
  return (configuration_ >> 13 & 7) < 4 ? apb2_MHz() : 2 * apb2_MHz();
}

bool Rcc::fail_crystal() {
  if ((control_ & kCrystalWatched) == 0) return false;
  control_ &= ~(kCrystal | kCrystalReady | kPllOn | kPllReady);
  configuration_ &= ~3u;
  switch_clock();
  return true;
}

std::uint32_t Rcc::read(std::uint32_t offset) {
  switch (offset) {
    case kControl:
      return clock_control();
    case kPll:
      return pll_;
    case kConfiguration:
      return configuration_ | (configuration_ & 3) << 2;
    case kAhb1:
      return ahb1_;
    case kApb1:
      return apb1_;
    case kApb2:
      return apb2_;
    case kStatus:
      return status_;
    default:
      no_such_register(offset);
  }
}

void Rcc::write(std::uint32_t offset, std::uint32_t value) {
  switch (offset) {
    case kControl:
      return write_clock_control(value);
    case kPll:
      if ((control_ & kPllOn) != 0) throw EmulatorError("RCC: PLLCFGR written while the PLL runs");
      pll_ = value;
      return;
    case kConfiguration:
      configuration_ = value & ~0xCu;
      return switch_clock();
    case kAhb1:
      ahb1_ = value;
      return;
    case kApb1:
      apb1_ = value;
      return;
    case kApb2:
      apb2_ = value;
      return;
    case kStatus:
      if ((value & kClearFlags) != 0) status_ = 0;
      return;
    default:
      no_such_register(offset);
  }
}

}  // namespace hoof::tools::emulator
