#include "tools/emulator/iwdg.h"

namespace hoof::tools::emulator {
namespace {

enum Offset { kKey = 0x0, kPrescaler = 0x4, kReload = 0x8, kStatus = 0xC };
constexpr std::uint32_t kFeed = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC;
constexpr std::uint32_t kUpdating = 3;
constexpr int kUpdateLooks = 3;

}  // namespace

void Iwdg::reset() {
  running_ = unlocked_ = false;
  prescaler_ = prescaler_used_ = 0;
  reload_ = reload_used_ = 0xFFF;
  updating_looks_ = 0;
}

void Iwdg::feed() {
  const std::int64_t slow_cycles = (std::int64_t{4} << prescaler_used_) * (reload_used_ + 1);
  deadline_ = time_.now + slow_cycles * 168'000'000 / oscillator_Hz_;
}

void Iwdg::write_key(std::uint32_t key) {
  unlocked_ = key == kUnlock;
  if (key == kStart && !running_) {
    running_ = true;
    feed();
  }
  if (key == kFeed) feed();
}

std::uint32_t Iwdg::read(std::uint32_t offset) {
  if (offset != kStatus) no_such_register(offset);
  if (updating_looks_ == 0) return 0;
  if (--updating_looks_ > 0) return kUpdating;
  prescaler_used_ = prescaler_;
  reload_used_ = reload_;
  return 0;
}

void Iwdg::write(std::uint32_t offset, std::uint32_t value) {
  if (offset == kKey) return write_key(value);
  if (offset != kPrescaler && offset != kReload) no_such_register(offset);
  if (!unlocked_) return;  // as the part: nothing happens
  if (offset == kPrescaler) prescaler_ = value & 7;
  if (offset == kReload) reload_ = value & 0xFFF;
  updating_looks_ = kUpdateLooks;
}

}  // namespace hoof::tools::emulator
