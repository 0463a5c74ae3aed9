// What all models of registers have in common.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hoof::tools::emulator {

/// The emulated board was asked for something that no model knows, or that no board can do: what(),
/// with address and place in the image. Never answered with a silent zero.
class EmulatorError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Time since power-on in cycles of 168 MHz; a multiple of 50 us is a whole number of them.
using Cycles = std::int64_t;
inline constexpr Cycles kCyclesPerMicrosecond = 168;
inline constexpr Cycles kCyclesPerMillisecond = 168'000;

constexpr Cycles cycles_of_ns(std::int64_t ns) {
  return ns * kCyclesPerMicrosecond / 1000;
}

/// One clock for all models; the board moves it.
struct BoardTime {
  Cycles now = 0;
};

inline std::string hex(std::uint32_t value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "0x00000000";
  for (std::size_t i = 0; i < 8; ++i) text[9 - i] = kDigits[value >> (4 * i) & 0xF];
  return text;
}

/// A block of 32-bit registers. Offsets are in bytes from its start.
class Peripheral {
 public:
  virtual ~Peripheral() = default;
  virtual const char* name() const = 0;
  virtual std::uint32_t read(std::uint32_t offset) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value) = 0;
  /// The registers as after a reset of the part.
  virtual void reset() = 0;

 protected:
  [[noreturn]] void no_such_register(std::uint32_t offset) const {
    throw EmulatorError(std::string(name()) + " has no model of the register at offset " +
                        hex(offset));
  }
};

}  // namespace hoof::tools::emulator
