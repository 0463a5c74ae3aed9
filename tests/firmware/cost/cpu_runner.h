// Runs functions of a linked image on an emulated Cortex-M4F (libunicorn) and counts instructions
// and cycles by cycle_rule.h. No peripherals and no interrupts: functions in, results out.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tools/emulator/elf_file.h"

namespace hoof::tests::cost {

struct Cost {
  std::uint64_t instructions = 0;
  std::uint64_t cycles = 0;  // wait cycles of the flash included
  std::uint64_t flash_wait_cycles = 0;
};

class CpuRunner {
 public:
  // Maps 1 MiB of flash at 0x08000000 and 128 KiB of RAM at 0x20000000, and loads the image; its
  // initialised data are where they are used, as after start-up. Throws std::runtime_error.
  explicit CpuRunner(const tools::emulator::ElfFile& image);
  ~CpuRunner();

  // Calls the function at a symbol's address with an integer argument; its cost is in cost().
  // The flash's caches are empty at the start, as after other code. Throws when it does not return
  // within a hundred million instructions, faults, or runs an instruction of unknown cost.
  std::uint32_t call(std::uint32_t address, std::uint32_t argument = 0);

  const Cost& cost() const;

  void write(std::uint32_t address, const void* bytes, std::size_t size);
  void read(std::uint32_t address, void* bytes, std::size_t size);

 private:
  struct Machine;
  std::unique_ptr<Machine> machine_;
};

}  // namespace hoof::tests::cost
