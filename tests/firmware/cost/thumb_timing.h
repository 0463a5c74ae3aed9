// The cost of one Thumb-2 instruction by its encoding (Armv7-M Architecture Reference Manual, A5
// and A6). Anything it does not know costs `unknown`, which a caller must treat as an error.
#pragma once

#include <cstdint>

namespace hoof::tests::cost {

struct Timing {
  std::uint32_t cycles = 0;
  std::uint32_t bytes = 2;
  // Floating-point registers s0 to s31, one bit each: read, and written by arithmetic whose result
  // is late by a cycle.
  std::uint32_t fp_reads = 0;
  std::uint32_t fp_late_writes = 0;
  bool known = true;
  // Works on doubles (the FPU of the M4F has none; 64-bit moves do not count).
  bool fp_double = false;
};

// `first` and `second`: the half-words at the instruction's address.
Timing timing_of(std::uint16_t first, std::uint16_t second);

}  // namespace hoof::tests::cost
