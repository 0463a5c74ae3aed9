// The processor alone: that it stores fast must not be seen in what it does.
#include "tools/emulator/cpu.h"

#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "tools/emulator/system_control.h"

using namespace hoof::tools::emulator;

namespace {

constexpr std::uint32_t kCode = 0x0800'0000, kRam = 0x2000'0000, kSlot = 0x0802'0000;

class Writes final : public RegisterSpace {
 public:
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t address, unsigned, std::uint32_t value) override {
    seen.push_back({address, value});
  }
  std::vector<std::array<std::uint32_t, 2>> seen;
};

struct Bench {
  Bench() {
    cpu.map_memory(kCode, 0x1000, Cpu::Access::kReadExecute);
    cpu.map_memory(kRam, 0x2000, Cpu::Access::kAll);
    cpu.map_flash(kSlot, slot, writes);
  }
  /// @param program from its first instruction to WFI, and what it loads behind
  Cpu::Stop run(const std::vector<std::uint16_t>& program) {
    cpu.write_memory(kCode, program.data(), 2 * program.size());
    CoreRegisters r;
    r.sp = kRam + 0x1000;
    r.pc = kCode;
    r.xpsr = 1u << 24;
    cpu.set_registers(r);
    return cpu.run();
  }

  alignas(4096) std::array<std::uint8_t, 0x1000> slot{};
  Writes writes;
  Cpu cpu{[] { return false; }};
};

/// Low half first, as it lies in memory.
#define HOOF_WORD(word) std::uint16_t(word), std::uint16_t((word) >> 16)

}  // namespace

TEST_CASE("code in RAM that is overwritten is executed as it stands") {
  Bench bench;
  const auto stop = bench.run({
      0x4C05,  // ldr r4, [pc, #20]   where
      0x4D06,  // ldr r5, [pc, #24]   movs r0, #1; bx lr
      0x4E06,  // ldr r6, [pc, #24]   movs r0, #2; bx lr
      0x4F07,  // ldr r7, [pc, #28]   where, as Thumb
      0x6025,
      0x47B8,
      0x0002,  // str r5, [r4]; blx r7; movs r2, r0
      0x6026,
      0x47B8,  // str r6, [r4]; blx r7
      0xBF30,
      0xBF00,
      0xBF00,  // wfi
      HOOF_WORD(kRam + 0x800),
      HOOF_WORD(0x4770'2001u),
      HOOF_WORD(0x4770'2002u),
      HOOF_WORD(kRam + 0x801),
  });
  REQUIRE(stop == Cpu::Stop::kSleep);
  CHECK(bench.cpu.registers().r2 == 1);
  CHECK(bench.cpu.registers().r0 == 2);
}

TEST_CASE("each store into flash goes to its controller, and changes nothing by itself") {
  Bench bench;
  const auto stop = bench.run({
      0x4C02,
      0x4D03,  // ldr r4, [pc, #8]; ldr r5, [pc, #12]
      0x6025,
      0x6065,  // str r5, [r4]; str r5, [r4, #4]
      0xBF30,
      0xBF00,  // wfi
      HOOF_WORD(kSlot + 0x100),
      HOOF_WORD(0xDEAD'BEEFu),
  });
  REQUIRE(stop == Cpu::Stop::kSleep);
  using Seen = std::vector<std::array<std::uint32_t, 2>>;
  CHECK(bench.writes.seen == Seen{{kSlot + 0x100, 0xDEAD'BEEF}, {kSlot + 0x104, 0xDEAD'BEEF}});
  CHECK(bench.slot[0x100] == 0);
}

TEST_CASE("a store into memory that only a programmer writes is a fault, and changes nothing") {
  Bench bench;
  const auto stop = bench.run({
      0x4C01,
      0x6024,
      0xBF30,
      0xBF00,  // ldr r4, [pc, #4]; str r4, [r4]; wfi
      HOOF_WORD(kCode + 0x100),
  });
  CHECK(stop == Cpu::Stop::kFault);
  CHECK(bench.cpu.fault().status == fault_status::kPreciseData);
  CHECK(bench.cpu.fault().address == kCode + 0x100);
  std::uint32_t there = 1;
  bench.cpu.read_memory(kCode + 0x100, &there, 4);
  CHECK(there == 0);
}
