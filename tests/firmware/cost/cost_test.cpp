// The measuring tool is tested first: costs of known encodings, the flash's caches, known
// functions.
#include <catch2/catch.hpp>

#include "tests/firmware/cost/cpu_runner.h"
#include "tests/firmware/cost/flash_accelerator.h"
#include "tests/firmware/cost/thumb_timing.h"

namespace hoof::tests::cost {
namespace {

using tools::emulator::ElfFile;

TEST_CASE("cycles of instructions as the assembler encodes them") {
  const struct {
    const char* text;
    std::uint16_t first, second;
    std::uint32_t cycles, bytes;
  } cases[] = {
      {"adds r0, r0, r1", 0x1840, 0, 1, 2},
      {"bx lr", 0x4770, 0, 1, 2},
      {"ldr r0, [pc, #4]", 0x4801, 0, 2, 2},
      {"str r0, [sp, #8]", 0x9002, 0, 2, 2},
      {"push {r4, r5, r6, lr}", 0xb570, 0, 5, 2},
      {"pop {r4, pc}", 0xbd10, 0, 3, 2},
      {"ldmia r0!, {r1, r2, r3}", 0xc80e, 0, 4, 2},
      {"it gt", 0xbfc8, 0, 1, 2},
      {"bne .", 0xd1fe, 0, 1, 2},
      {"b.n .", 0xe7fe, 0, 1, 2},
      {"bl .", 0xf7ff, 0xfffe, 1, 4},
      {"stmdb sp!, {r4-r8, lr}", 0xe92d, 0x41f0, 7, 4},
      {"ldrd r0, r1, [r2]", 0xe9d2, 0x0100, 3, 4},
      {"tbb [pc, r0]", 0xe8df, 0xf000, 2, 4},
      {"add.w r0, r1, r2", 0xeb01, 0x0002, 1, 4},
      {"movw r0, #4660", 0xf241, 0x2034, 1, 4},
      {"ldr.w r0, [r1, #256]", 0xf8d1, 0x0100, 2, 4},
      {"mul.w r0, r1, r2", 0xfb01, 0xf002, 1, 4},
      {"udiv r0, r1, r2", 0xfbb1, 0xf0f2, 12, 4},
      {"sdiv r0, r1, r2", 0xfb91, 0xf0f2, 12, 4},
      {"umull r0, r1, r2, r3", 0xfba2, 0x0103, 1, 4},
      {"vadd.f32 s0, s1, s2", 0xee30, 0x0a81, 1, 4},
      {"vmul.f32 s0, s1, s2", 0xee20, 0x0a81, 1, 4},
      {"vmla.f32 s0, s1, s2", 0xee00, 0x0a81, 3, 4},
      {"vdiv.f32 s0, s1, s2", 0xee80, 0x0a81, 14, 4},
      {"vsqrt.f32 s0, s1", 0xeeb1, 0x0ae0, 14, 4},
      {"vneg.f32 s0, s1", 0xeeb1, 0x0a60, 1, 4},
      {"vcmp.f32 s0, s1", 0xeeb4, 0x0a60, 1, 4},
      {"vmrs APSR_nzcv, fpscr", 0xeef1, 0xfa10, 1, 4},
      {"vmov r0, s0", 0xee10, 0x0a10, 1, 4},
      {"vldr s0, [r0]", 0xed90, 0x0a00, 2, 4},
      {"vstr s1, [r0]", 0xedc0, 0x0a00, 2, 4},
      {"vpush {s16-s19}", 0xed2d, 0x8a04, 5, 4},
      {"vpop {d8-d9}", 0xecbd, 0x8b04, 5, 4},
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const Timing timing = timing_of(c.first, c.second);
    CHECK(timing.known);
    CHECK(timing.cycles == c.cycles);
    CHECK(timing.bytes == c.bytes);
  }
  CHECK_FALSE(timing_of(0xde00, 0).known);       // udf
  CHECK_FALSE(timing_of(0xee10, 0x0f10).known);  // mrc of another coprocessor
}

TEST_CASE("registers that a floating-point instruction waits for") {
  const Timing sum = timing_of(0xee30, 0x0a81);  // vadd.f32 s0, s1, s2
  CHECK(sum.fp_late_writes == 1u << 0);
  CHECK(sum.fp_reads == (1u << 1 | 1u << 2));
  const Timing accumulate = timing_of(0xee40, 0x1a20);  // vmla.f32 s3, s0, s1
  CHECK(accumulate.fp_late_writes == 1u << 3);
  CHECK(accumulate.fp_reads == (1u << 0 | 1u << 1 | 1u << 3));
  CHECK(timing_of(0xedc0, 0x0a00).fp_reads == 1u << 1);  // vstr s1, [r0]
  CHECK(timing_of(0xed90, 0x0a00).fp_reads == 0);        // vldr s0, [r0]
  CHECK(timing_of(0xee30, 0x0b01).fp_double);            // vadd.f64 d0, d0, d1
}

TEST_CASE("wait cycles of the flash") {
  FlashAccelerator flash;
  CHECK(flash.fetch(0x08000000) == 5);  // a jump to a line not cached
  CHECK(flash.fetch(0x08000002) == 0);  // the same line
  flash.spend(4);
  CHECK(flash.fetch(0x08000010) == 2);  // the next: its prefetch began four cycles ago
  flash.spend(10);
  CHECK(flash.fetch(0x08000020) == 0);
  CHECK(flash.fetch(0x08000000) == 0);  // cached
  // 64 other lines push it out.
  for (std::uint32_t line = 100; line < 164; ++line) flash.fetch(0x08000000 + 32 * line);
  CHECK(flash.fetch(0x08000000) == 5);
  CHECK(flash.load(0x08001000) == 5);
  CHECK(flash.load(0x08001004) == 0);
}

// Code at the start of the flash, as a loader would place it.
ElfFile code(const std::vector<std::uint16_t>& words) {
  ElfFile::Segment segment{0x08000000, 0x08000000, {}};
  for (const std::uint16_t word : words) {
    segment.bytes.push_back(static_cast<std::uint8_t>(word & 0xff));
    segment.bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  return {{segment}, {}};
}

TEST_CASE("a function is called, counted, and returns") {
  // loop: subs r0, #1; bne loop; bx lr
  CpuRunner cpu(code({0x3801, 0xd1fd, 0x4770}));
  CHECK(cpu.call(0x08000000, 10) == 0);
  CHECK(cpu.cost().instructions == 21);
  // 21 single cycles; nine jumps back, the call and the return at three; five waits for the flash.
  CHECK(cpu.cost().cycles == 21 + 11 * 3 + 5);
  CHECK(cpu.cost().flash_wait_cycles == 5);
}

TEST_CASE("a result used by the next instruction costs a cycle") {
  // vadd.f32 s0, s1, s2; vmul.f32 s3, s0, s0 (waits) or vmul.f32 s3, s1, s1; bx lr
  CpuRunner waits(code({0xee30, 0x0a81, 0xee60, 0x1a00, 0x4770}));
  waits.call(0x08000000);
  CpuRunner goes_on(code({0xee30, 0x0a81, 0xee60, 0x1aa0, 0x4770}));
  goes_on.call(0x08000000);
  CHECK(waits.cost().cycles == goes_on.cost().cycles + 1);
}

TEST_CASE("what cannot be counted is an error") {
  CpuRunner lost(code({0xe7ff, 0xde00}));  // runs into an undefined instruction
  CHECK_THROWS(lost.call(0x08000000));
  CpuRunner endless(code({0xe7fe}));
  CHECK_THROWS_WITH(endless.call(0x08000000), Catch::Contains("no end in sight"));
  CHECK_THROWS(tools::emulator::read_elf_file(HOOF_TEST_DATA_DIR "/trajectory/README.md"));
}

}  // namespace
}  // namespace hoof::tests::cost
