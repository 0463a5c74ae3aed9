// A Cortex-M4F by libunicorn: instructions, memory, and stops where the world around it must act.
// Unicorn has no exceptions, no NVIC and no faults of Armv7-M: those are Core's.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

/// What is behind addresses that are not plain memory.
class RegisterSpace {
 public:
  virtual std::uint32_t read(std::uint32_t address, unsigned bytes) = 0;
  virtual void write(std::uint32_t address, unsigned bytes, std::uint32_t value) = 0;

 protected:
  ~RegisterSpace() = default;
};

struct CoreRegisters {
  std::uint32_t r0 = 0, r1 = 0, r2 = 0, r3 = 0, r12 = 0, sp = 0, lr = 0, pc = 0, xpsr = 0;
  std::uint32_t control = 0;
};

class Cpu {
 public:
  enum class Stop {
    kSleep,            // WFI
    kExceptionReturn,  // a branch to EXC_RETURN, which pc then holds
    kCheckpoint,       // interrupts may have been unmasked
    kFault,            // fault() says which
    kRequested,        // request_stop()
    kStuck,            // ran for kMostBlocks without any of the others
  };
  struct Fault {
    std::uint32_t status = 0;  // bits of CFSR, addresses being valid not among them
    std::uint32_t address = 0;
  };
  enum class Access { kReadExecute, kAll };
  /// Called before each instruction.
  using Observer = std::function<void(std::uint32_t address)>;

  /// Of one stretch between two stops; a tick takes some thousands.
  static constexpr std::uint64_t kMostBlocks = 20'000'000;

  /// @param interrupt_waits whether unmasking could let an exception in
  explicit Cpu(std::function<bool()> interrupt_waits);
  ~Cpu();
  Cpu(const Cpu&) = delete;
  Cpu& operator=(const Cpu&) = delete;

  void map_memory(std::uint32_t base, std::uint32_t bytes, Access access);
  void map_registers(std::uint32_t base, std::uint32_t bytes, RegisterSpace& space);
  /// Memory of the caller's that the core reads and executes; what it stores there goes to `writes`
  /// and changes nothing by itself. After a change call forget_code().
  void map_flash(std::uint32_t base, std::span<std::uint8_t> memory, RegisterSpace& writes);
  /// What was translated of these addresses is no longer what stands there. Not while it runs.
  void forget_code(std::uint32_t base, std::uint32_t bytes);
  /// While an interrupt waits, stops at instructions that follow one which may unmask interrupts,
  /// wherever they are in `code`.
  void watch_unmasking(std::uint32_t run_address, std::span<const std::uint8_t> code);

  /// Also into memory that the image cannot write. @return false where there is none
  bool write_memory(std::uint32_t address, const void* bytes, std::size_t size);
  bool read_memory(std::uint32_t address, void* bytes, std::size_t size);

  CoreRegisters registers() const;
  void set_registers(const CoreRegisters& registers);
  /// s0 to s15, and FPSCR at the end.
  void read_fp(std::span<std::uint32_t, 17> words) const;
  void write_fp(std::span<const std::uint32_t, 17> words);

  struct MaskRegisters {
    std::uint32_t primask = 0, faultmask = 0, basepri = 0;
  };
  MaskRegisters masks() const;
  void set_masks(const MaskRegisters& masks);

  /// From pc on. @throws what a RegisterSpace threw
  Stop run();
  const Fault& fault() const;
  /// From within a RegisterSpace: the core stops some instructions later.
  void request_stop();
  /// Slow; empty ends it.
  void observe(Observer observer);
  std::uint64_t blocks() const;

 private:
  struct Machine;
  std::unique_ptr<Machine> machine_;
};

}  // namespace hoof::tools::emulator
