// Power control: the early warning of a falling supply.
//
// Source: RM0090 rev. 19, 5.4.
#pragma once

#include <cstdint>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class Pwr final : public Peripheral {
 public:
  const char* name() const override { return "PWR"; }

  std::uint32_t read(std::uint32_t offset) override {
    if (offset == 0) return control_;
    if (offset == 4) return status_ | (detects() ? 1u << 2 : 0);
    no_such_register(offset);
  }
  void write(std::uint32_t offset, std::uint32_t value) override {
    if (offset == 0) {
      control_ = value;
    } else if (offset == 4) {
      status_ = value & 0x300;  // EWUP, BRE
    } else {
      no_such_register(offset);
    }
  }
  void reset() override {
    control_ = 0x4000;
    status_ = 0;
  }

  /// The supply is below 2.9 V, the detector's highest level, and above the level of the reset.
  void set_supply_low(bool low) { supply_low_ = low; }

 private:
  bool detects() const {
    constexpr std::uint32_t kOn = 1u << 4, kHighestLevel = 7u << 5;
    return supply_low_ && (control_ & kOn) != 0 && (control_ & kHighestLevel) == kHighestLevel;
  }

  std::uint32_t control_ = 0;
  std::uint32_t status_ = 0;
  bool supply_low_ = false;
};

}  // namespace hoof::tools::emulator
