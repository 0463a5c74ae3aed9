#include "tests/firmware/cost/thumb_timing.h"

#include <bit>

#include "tests/firmware/cost/cycle_rule.h"

namespace hoof::tests::cost {
namespace {

constexpr CycleRule kRule = kCycleRule;

std::uint32_t bits(std::uint32_t word, int high, int low) {
  return word >> low & ((1u << (high - low + 1)) - 1);
}

std::uint32_t transfer(int registers) {
  const auto more = static_cast<std::uint32_t>(registers > 1 ? registers - 1 : 0);
  return kRule.load_store + more * kRule.more_registers;
}

Timing simple(std::uint32_t cycles, std::uint32_t bytes) {
  Timing timing;
  timing.cycles = cycles;
  timing.bytes = bytes;
  return timing;
}

Timing unknown(std::uint32_t bytes) {
  Timing timing = simple(0, bytes);
  timing.known = false;
  return timing;
}

// A5.2: sixteen-bit instructions. The refill of a taken jump is the caller's to add.
Timing short_timing(std::uint16_t op) {
  if (op < 0x4800) return simple(kRule.alu, 2);         // data processing, BX, BLX
  if (op < 0xA000) return simple(kRule.load_store, 2);  // literal, register, immediate, SP
  if (op < 0xB000) return simple(kRule.alu, 2);         // ADR, ADD SP
  if (op < 0xC000) {
    const std::uint32_t kind = bits(op, 11, 8);
    if (kind == 0x4 || kind == 0x5 || kind == 0xC || kind == 0xD) {  // PUSH, POP
      return simple(transfer(std::popcount(bits(op, 8, 0))), 2);
    }
    return simple(kRule.alu, 2);  // adjust SP, extend, CBZ, REV, IT, hints
  }
  if (op < 0xD000) return simple(transfer(std::popcount(bits(op, 7, 0))), 2);  // STM, LDM
  if (op >= 0xDE00 && op < 0xE000) return unknown(2);                          // UDF, SVC
  return simple(kRule.alu, 2);                                                 // B<c>, B
}

constexpr std::uint32_t single(std::uint32_t high_bits, std::uint32_t low_bit) {
  return 1u << (high_bits << 1 | low_bit);
}

// A6.4: one register d, n and m of a single-precision instruction.
struct FpRegisters {
  FpRegisters(std::uint16_t first, std::uint16_t second)
      : d(single(bits(second, 15, 12), bits(first, 6, 6))),
        n(single(bits(first, 3, 0), bits(second, 7, 7))),
        m(single(bits(second, 3, 0), bits(second, 5, 5))) {}
  std::uint32_t d, n, m;
};

Timing fp_arithmetic(std::uint16_t first, std::uint16_t second) {
  const FpRegisters r(first, second);
  Timing timing = simple(kRule.fp, 4);
  timing.fp_double = bits(second, 8, 8) != 0;
  timing.fp_late_writes = r.d;
  const std::uint32_t opcode = bits(first, 7, 4) & 0xB;
  const bool immediate_or_compare = opcode == 0xB;
  if (!immediate_or_compare) {
    timing.fp_reads = r.n | r.m;
    if (opcode == 0x8) timing.cycles = kRule.fp_divide;
    const bool accumulates = opcode == 0x0 || opcode == 0x1 || opcode == 0x9 || opcode == 0xA;
    if (accumulates) {
      timing.cycles = kRule.fp_multiply_add;
      timing.fp_reads |= r.d;
    }
    return timing;
  }
  if (bits(second, 6, 6) == 0) return timing;  // VMOV immediate
  const std::uint32_t kind = bits(first, 3, 0);
  timing.fp_reads = r.m;
  const bool compares = kind == 0x4 || kind == 0x5;
  if (compares) {
    timing.fp_reads = r.d | (kind == 0x4 ? r.m : 0);
    timing.fp_late_writes = 0;
  }
  if (kind == 0x1 && bits(second, 7, 6) == 3) timing.cycles = kRule.fp_divide;  // VSQRT
  return timing;
}

// A6.5, A6.6: loads and stores; A6.7, A6.8: moves from and to core registers.
Timing fp_transfer(std::uint16_t first, std::uint16_t second) {
  const FpRegisters r(first, second);
  const bool load = bits(first, 4, 4) != 0;
  if (bits(first, 11, 8) == 0xE) {  // MCR, MRC: VMOV one register, VMRS, VMSR
    Timing timing = simple(kRule.fp, 4);
    if (load) timing.fp_reads = r.n;
    return timing;
  }
  const bool pair = bits(first, 11, 5) == 0x62;  // VMOV of two core registers
  if (pair) {
    Timing timing = simple(2 * kRule.fp, 4);
    timing.fp_reads = load ? ~0u : 0;
    return timing;
  }
  const bool one = bits(first, 8, 8) != 0 && bits(first, 5, 5) == 0;  // VLDR, VSTR
  const bool doubles = bits(second, 8, 8) != 0;
  const int words = one ? (doubles ? 2 : 1) : static_cast<int>(bits(second, 7, 0));
  Timing timing = simple(transfer(words), 4);
  if (!load) timing.fp_reads = one && !doubles ? r.d : ~0u;
  return timing;
}

Timing coprocessor(std::uint16_t first, std::uint16_t second) {
  const std::uint32_t number = bits(second, 11, 8);
  if (number != 0xA && number != 0xB) return unknown(4);
  const bool arithmetic = bits(first, 11, 8) == 0xE && bits(second, 4, 4) == 0;
  return arithmetic ? fp_arithmetic(first, second) : fp_transfer(first, second);
}

// A5.3: thirty-two-bit instructions.
Timing long_timing(std::uint16_t first, std::uint16_t second) {
  const std::uint32_t op1 = bits(first, 12, 11);
  const std::uint32_t op2 = bits(first, 10, 4);
  if (op1 != 2 && (op2 & 0x40) != 0) return coprocessor(first, second);
  if (op1 == 1) {
    if ((op2 & 0x64) == 0x00) return simple(transfer(std::popcount(second)), 4);  // LDM, STM
    if ((op2 & 0x64) == 0x04) {
      const bool table = bits(first, 11, 4) == 0x8D && bits(second, 7, 5) == 0;
      return table ? simple(kRule.table_branch, 4) : simple(transfer(2), 4);  // TBB, LDRD, STRD
    }
    return simple(kRule.alu, 4);  // data processing, shifted register
  }
  if (op1 == 2) return simple(kRule.alu, 4);  // immediates; branches, MSR, MRS, barriers
  if ((op2 & 0x60) == 0x00) return simple(kRule.load_store, 4);  // one load or store
  if ((op2 & 0x78) == 0x38) {                                    // long multiply, divide
    const bool divides = bits(first, 6, 4) == 1 || bits(first, 6, 4) == 3;
    return simple(divides ? kRule.integer_divide : kRule.alu, 4);
  }
  return simple(kRule.alu, 4);  // data processing, register; multiply
}

}  // namespace

Timing timing_of(std::uint16_t first, std::uint16_t second) {
  return first >= 0xE800 ? long_timing(first, second) : short_timing(first);
}

}  // namespace hoof::tests::cost
