// What one instruction costs on a Cortex-M4F at 168 MHz behind the flash of an STM32F405. A rule,
// not a measurement on a board: deterministic, so that a test may gate on it.
//
// Sources:
//   [TRM] Arm Cortex-M4 Processor Technical Reference Manual (100166), "Processor instructions" and
//         "FPU instruction set": cycles of each instruction without wait states.
//   [RM]  STM32F405 reference manual (RM0090), "Adaptive real-time memory accelerator": at 168 MHz
//         and 3.3 V five wait states; flash is read in lines of 128 bits; the next line is
//         prefetched; 64 lines are cached for instructions and 8 for data.
// Where a source gives a range the rule takes its upper end: three cycles to refill the pipeline
// (1 to 3), twelve for an integer division (2 to 12). Loads are never pipelined, an instruction
// that its IT block skips is charged in full, and a floating-point result used by the very next
// instruction costs one more.
#pragma once

#include <cstdint>

namespace hoof::tests::cost {

struct CycleRule {
  std::uint32_t alu = 1;
  std::uint32_t load_store = 2;           // the first register
  std::uint32_t more_registers = 1;       // each further one
  std::uint32_t refill = 3;               // on top, for every jump that is taken
  std::uint32_t table_branch = 2;         // TBB, TBH; and the refill
  std::uint32_t integer_divide = 12;      // SDIV, UDIV
  std::uint32_t fp = 1;                   // VADD, VMUL, VCMP, VCVT, VMOV ...
  std::uint32_t fp_multiply_add = 3;      // VMLA and its like
  std::uint32_t fp_divide = 14;           // VDIV, VSQRT
  std::uint32_t fp_result_used_next = 1;  // on top
};

struct FlashRule {
  std::uint32_t line_bytes = 16;
  std::uint32_t line_cycles = 6;  // to read one: five wait states and the access itself
  std::uint32_t instruction_lines = 64;
  std::uint32_t data_lines = 8;
};

inline constexpr CycleRule kCycleRule;
inline constexpr FlashRule kFlashRule;
inline constexpr double kClockHz = 168e6;

}  // namespace hoof::tests::cost
