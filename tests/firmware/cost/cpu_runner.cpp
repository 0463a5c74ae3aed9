#include "tests/firmware/cost/cpu_runner.h"

#include <unicorn/unicorn.h>

#include <cstdio>
#include <stdexcept>

#include "tests/firmware/cost/flash_accelerator.h"
#include "tests/firmware/cost/thumb_timing.h"

namespace hoof::tests::cost {
namespace {

constexpr std::uint32_t kFlash = 0x08000000;
constexpr std::uint32_t kFlashSize = 1u << 20;
constexpr std::uint32_t kRam = 0x20000000;
constexpr std::uint32_t kRamSize = 128u << 10;
constexpr std::uint32_t kReturn = kFlash + kFlashSize - 16;  // nothing is linked there
constexpr std::uint64_t kMostInstructions = 100'000'000;

void check(uc_err error, const char* what) {
  if (error != UC_ERR_OK) {
    throw std::runtime_error(std::string("emulator, ") + what + ": " + uc_strerror(error));
  }
}

}  // namespace

struct CpuRunner::Machine {
  uc_engine* engine = nullptr;
  std::vector<Timing> timings;  // of the half-word at each even address of the flash; 0 bytes: new
  FlashAccelerator flash;
  Cost cost;
  std::uint32_t expected = 0;  // where execution goes on when there is no jump
  std::uint32_t late_registers = 0;
  std::string fault;

  ~Machine() { uc_close(engine); }

  const Timing& timing_at(std::uint32_t address) {
    Timing& timing = timings[(address - kFlash) / 2];
    if (timing.bytes == 0) {
      std::uint16_t words[2];
      check(uc_mem_read(engine, address, words, sizeof words), "read code");
      timing = timing_of(words[0], words[1]);
    }
    return timing;
  }

  static void on_code(uc_engine*, std::uint64_t address, std::uint32_t, void* machine) {
    static_cast<Machine*>(machine)->execute(static_cast<std::uint32_t>(address));
  }

  static void on_read(uc_engine*, uc_mem_type, std::uint64_t address, int, std::int64_t,
                      void* machine) {
    static_cast<Machine*>(machine)->load(static_cast<std::uint32_t>(address));
  }

  void execute(std::uint32_t address) {
    if (address < kFlash || address >= kReturn) {
      stop("execution outside the flash", address);
      return;
    }
    const Timing& timing = timing_at(address);
    if (!timing.known) stop("an instruction of unknown cost", address);
    const bool jumped = address != expected;
    std::uint32_t cycles = timing.cycles + (jumped ? kCycleRule.refill : 0);
    if ((timing.fp_reads & late_registers) != 0) cycles += kCycleRule.fp_result_used_next;
    const std::uint32_t wait = flash.fetch(address);
    cycles += wait;
    flash.spend(cycles);
    cost.flash_wait_cycles += wait;
    cost.cycles += cycles;
    if (++cost.instructions > kMostInstructions) stop("no end in sight", address);
    expected = address + timing.bytes;
    late_registers = timing.fp_late_writes;
  }

  void load(std::uint32_t address) {
    if (address < kFlash || address >= kFlash + kFlashSize) return;
    const std::uint32_t wait = flash.load(address);
    cost.cycles += wait;
    cost.flash_wait_cycles += wait;
  }

  void stop(const char* why, std::uint32_t address) {
    char text[100];
    std::snprintf(text, sizeof text, "%s at 0x%08x", why, address);
    fault = text;
    uc_emu_stop(engine);
  }
};

CpuRunner::CpuRunner(const tools::emulator::ElfFile& image)
    : machine_(std::make_unique<Machine>()) {
  Machine& m = *machine_;
  check(uc_open(UC_ARCH_ARM, static_cast<uc_mode>(UC_MODE_THUMB | UC_MODE_MCLASS), &m.engine),
        "open");
  check(uc_ctl_set_cpu_model(m.engine, UC_CPU_ARM_CORTEX_M4), "choose a Cortex-M4");
  check(uc_mem_map(m.engine, kFlash, kFlashSize, UC_PROT_READ | UC_PROT_EXEC), "map flash");
  check(uc_mem_map(m.engine, kRam, kRamSize, UC_PROT_READ | UC_PROT_WRITE), "map RAM");
  for (const auto& segment : image.segments) {
    write(segment.run_address, segment.bytes.data(), segment.bytes.size());
  }
  Timing unread;
  unread.bytes = 0;
  m.timings.assign(kFlashSize / 2, unread);
  uc_hook hook;
  check(uc_hook_add(m.engine, &hook, UC_HOOK_CODE, reinterpret_cast<void*>(Machine::on_code), &m, 1,
                    0),
        "hook code");
  check(uc_hook_add(m.engine, &hook, UC_HOOK_MEM_READ, reinterpret_cast<void*>(Machine::on_read),
                    &m, kFlash, kFlash + kFlashSize),
        "hook loads");
}

CpuRunner::~CpuRunner() = default;

std::uint32_t CpuRunner::call(std::uint32_t address, std::uint32_t argument) {
  Machine& m = *machine_;
  const std::uint32_t stack = kRam + kRamSize - 8;
  const std::uint32_t link = kReturn | 1;
  check(uc_reg_write(m.engine, UC_ARM_REG_SP, &stack), "set the stack");
  check(uc_reg_write(m.engine, UC_ARM_REG_LR, &link), "set the return");
  check(uc_reg_write(m.engine, UC_ARM_REG_R0, &argument), "set the argument");
  m.cost = {};
  m.flash.clear();
  m.fault.clear();
  m.late_registers = 0;
  m.expected = 0;  // the call itself is a jump
  const uc_err error = uc_emu_start(m.engine, address | 1, kReturn, 0, 0);
  if (!m.fault.empty()) throw std::runtime_error("emulator: " + m.fault);
  check(error, "run");
  m.cost.cycles += kCycleRule.refill;  // the jump back
  std::uint32_t result = 0;
  check(uc_reg_read(m.engine, UC_ARM_REG_R0, &result), "read the result");
  return result;
}

const Cost& CpuRunner::cost() const {
  return machine_->cost;
}

void CpuRunner::write(std::uint32_t address, const void* bytes, std::size_t size) {
  check(uc_mem_write(machine_->engine, address, bytes, size), "write memory");
}

void CpuRunner::read(std::uint32_t address, void* bytes, std::size_t size) {
  check(uc_mem_read(machine_->engine, address, bytes, size), "read memory");
}

}  // namespace hoof::tests::cost
