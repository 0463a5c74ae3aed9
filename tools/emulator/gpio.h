// One port of pins.
//
// Source: RM0090 rev. 19, 8.4.
#pragma once

#include <array>
#include <cstdint>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class Gpio final : public Peripheral {
 public:
  enum class Mode : std::uint8_t { kInput = 0, kOutput, kAlternate, kAnalog };

  /// MODER, OSPEEDR and PUPDR as after a reset: some pins are the debugger's.
  struct Fresh {
    const char* name;
    std::uint32_t modes, speeds, pulls;
  };
  static constexpr Fresh kPortA = {"GPIO A", 0xA800'0000, 0x0C00'0000, 0x6400'0000};
  static constexpr Fresh kPortB = {"GPIO B", 0x0000'0280, 0x0000'00C0, 0x0000'0100};
  static constexpr Fresh kPortC = {"GPIO C", 0, 0, 0};

  explicit Gpio(const Fresh& fresh) : fresh_(fresh) {}

  const char* name() const override { return fresh_.name; }

  std::uint32_t read(std::uint32_t offset) override {
    if (offset == kInputData) return levels();
    if (offset >= registers_.size() * 4 || offset == kSetReset) no_such_register(offset);
    return registers_[offset / 4];
  }
  void write(std::uint32_t offset, std::uint32_t value) override {
    if (offset == kSetReset) {
      registers_[kOutputData / 4] |= value & 0xFFFF;
      registers_[kOutputData / 4] &= ~(value >> 16 & ~value);
      return;
    }
    if (offset >= registers_.size() * 4 || offset == kInputData) no_such_register(offset);
    registers_[offset / 4] = value;
  }
  void reset() override {
    registers_ = {};
    registers_[kModes / 4] = fresh_.modes;
    registers_[kSpeeds / 4] = fresh_.speeds;
    registers_[kPulls / 4] = fresh_.pulls;
  }

  /// What is wired to a pin: high, or nothing.
  void wire_high(std::uint32_t pin, bool high) {
    driven_high_ = (driven_high_ & ~(1u << pin)) | std::uint32_t{high} << pin;
  }

  /// What a pin that is not an output has: 1 or 0.
  bool level(std::uint32_t pin) const { return (levels() >> pin & 1) != 0; }
  bool has_function(std::uint32_t pin, std::uint32_t function) const {
    return mode(pin) == Mode::kAlternate && alternate(pin) == function;
  }
  Mode mode(std::uint32_t pin) const { return Mode(registers_[kModes / 4] >> (2 * pin) & 3); }
  std::uint32_t alternate(std::uint32_t pin) const {
    return registers_[(kAlternates + 4 * (pin / 8)) / 4] >> (4 * (pin % 8)) & 0xF;
  }

 private:
  enum Offset {
    kModes = 0x00,
    kSpeeds = 0x08,
    kPulls = 0x0C,
    kInputData = 0x10,
    kOutputData = 0x14,
    kSetReset = 0x18,
    kAlternates = 0x20
  };

  /// A pin that nothing drives reads as it is pulled; without a pull, low.
  std::uint32_t levels() const {
    std::uint32_t value = 0;
    for (std::uint32_t pin = 0; pin < 16; ++pin) {
      const bool up = (registers_[kPulls / 4] >> (2 * pin) & 3) == 1;
      const bool output = mode(pin) == Mode::kOutput;
      const bool high = output ? (registers_[kOutputData / 4] >> pin & 1) != 0
                               : (driven_high_ >> pin & 1) != 0 || up;
      value |= std::uint32_t{high} << pin;
    }
    return value;
  }

  const Fresh& fresh_;
  std::array<std::uint32_t, 10> registers_{};
  std::uint32_t driven_high_ = 0;
};

}  // namespace hoof::tools::emulator
