#include "tools/emulator/timer1.h"

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kControl1 = 0x00,
  kControl2 = 0x04,
  kInterrupts = 0x0C,
  kStatus = 0x10,
  kEvents = 0x14,
  kMode1 = 0x18,
  kOutputs = 0x20,
  kPrescaler = 0x28,
  kReload = 0x2C,
  kCompare1 = 0x34,
  kOutputControl = 0x44
};

constexpr std::uint32_t kCounts = 1u << 0, kReloadBuffered = 1u << 7;
constexpr std::uint32_t kBreak = 1u << 7;  // BIE, BIF
constexpr std::uint32_t kPwm1 = 6u << 4, kCompareBuffered = 1u << 3;
constexpr std::uint32_t kChannel1 = 1u << 0;
constexpr std::uint32_t kUpdate = 1u << 0;
constexpr std::uint32_t kDeadTime = 0xFF, kLock = 3u << 8, kOffStates = 3u << 10;
constexpr std::uint32_t kBreakOn = 1u << 12, kBreakHigh = 1u << 13, kAutomatic = 1u << 14,
                        kMainOutput = 1u << 15;
constexpr std::uint32_t kIdleDriven = 1u << 10;

}  // namespace

void Timer1::reset() {
  control_ = interrupts_ = status_ = mode_ = outputs_ = 0;
  prescaler_ = prescaler_used_ = compare_ = output_control_ = 0;
  reload_ = 0xFFFF;
  output_control_written_ = false;
  update_line();
}

bool Timer1::break_on() const {
  return (output_control_ & kBreakOn) != 0;
}

bool Timer1::break_active() const {
  return break_on() && break_level_() == ((output_control_ & kBreakHigh) != 0);
}

void Timer1::note_break() {
  if (!break_on()) return;
  output_control_ &= ~kMainOutput;
  status_ |= kBreak;
  update_line();
}

void Timer1::on_input() {
  if (break_active()) note_break();
}

void Timer1::update_line() {
  nvic_.set_line(exception::kFirstInterrupt + kBreakInterrupt,
                 (status_ & interrupts_ & kBreak) != 0);
}

double Timer1::wave_Hz() const {
  const bool out = (output_control_ & kMainOutput) != 0 && (outputs_ & kChannel1) != 0;
  const bool wave =
      (control_ & kCounts) != 0 && (mode_ & 0x70) == kPwm1 && compare_ > 0 && compare_ <= reload_;
  if (!out || !wave) return 0;
  return clock_MHz_() * 1e6 / (prescaler_used_ + 1) / (reload_ + 1);
}

/// LOCK level 1 keeps dead time, BKE, BKP and AOE as they are, level 2 the off-states, too; level 3
/// the channels' modes. MOE is never locked.
void Timer1::write_output_control(std::uint32_t value) {
  const std::uint32_t level = output_control_ >> 8 & 3;
  std::uint32_t kept = output_control_written_ ? kLock : 0;
  if (level >= 1) kept |= kDeadTime | kBreakOn | kBreakHigh | kAutomatic;
  if (level >= 2) kept |= kOffStates;
  output_control_written_ = true;
  value = (value & ~kept) | (output_control_ & kept);
  const std::uint32_t modelled = kLock | kIdleDriven | kBreakOn | kMainOutput;
  if ((value & ~modelled) != 0) {
    throw EmulatorError("TIM1 has no model of BDTR = " + hex(value));
  }
  output_control_ = value;
  if (break_active()) note_break();  // the level wins over the write
}

std::uint32_t& Timer1::plain(std::uint32_t offset) {
  switch (offset) {
    case kControl1:
      return control_;
    case kInterrupts:
      return interrupts_;
    case kStatus:
      return status_;
    case kMode1:
      return mode_;
    case kOutputs:
      return outputs_;
    case kPrescaler:
      return prescaler_;
    case kReload:
      return reload_;
    case kCompare1:
      return compare_;
    case kOutputControl:
      return output_control_;
    default:
      no_such_register(offset);
  }
}

std::uint32_t Timer1::read(std::uint32_t offset) {
  return plain(offset);
}

void Timer1::write(std::uint32_t offset, std::uint32_t value) {
  const auto only = [&](std::uint32_t modelled) {
    if ((value & ~modelled) == 0) return;
    throw EmulatorError("TIM1 has no model of the register at offset " + hex(offset) + " = " +
                        hex(value));
  };
  switch (offset) {
    case kEvents:
      only(kUpdate);
      if ((value & kUpdate) != 0) prescaler_used_ = prescaler_;
      return;
    case kStatus:
      status_ &= value;
      if (break_active()) note_break();
      return update_line();
    case kInterrupts:
      only(kBreak);
      interrupts_ = value;
      return update_line();
    case kMode1:
      if ((output_control_ & kLock) == kLock) return;  // as the part: nothing happens
      only(0x70 | kCompareBuffered);
      mode_ = value;
      return;
    case kControl1:
      only(kCounts | kReloadBuffered);
      break;
    case kOutputs:
      only(kChannel1);
      break;
    case kOutputControl:
      return write_output_control(value);
    case kPrescaler:
    case kReload:
    case kCompare1:
      only(0xFFFF);
      break;
    default:
      no_such_register(offset);
  }
  plain(offset) = value;
}

}  // namespace hoof::tools::emulator
