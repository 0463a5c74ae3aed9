// The flash of an STM32F405 for tests: the lock, the sequences and the bits as RM0090, 3.6 has
// them.
#pragma once

#include <string>
#include <vector>

#include "firmware/board/stm32f405/flash_memory.h"
#include "tests/firmware/board/stm32f405/simulated_registers.h"

namespace hoof::tests {

struct SimulatedFlash {
  using FlashMemory = firmware::stm32f405::FlashMemory;

  SimulatedFlash();

  SimulatedRegisters access;
  firmware::stm32f405::FlashRegisters registers;
  firmware::stm32f405::IwdgRegisters iwdg;
  firmware::stm32f405::SysTickRegisters systick;
  firmware::stm32f405::ScbRegisters scb;
  std::vector<hal::Register> words{FlashMemory::kSectors * FlashMemory::kSectorWords};
  firmware::stm32f405::Watchdog watchdog{iwdg};
  firmware::stm32f405::SystemClock clock{systick, scb};
  FlashMemory memory{registers, words.data(), watchdog, clock};

  int erase_ms = 250;
  std::uint32_t next_error = 0;  // bits of SR that the next operation raises
  bool never_done = false;
  bool tick_runs = true;
  std::vector<int> erased_sectors;  // numbers of the part
  std::vector<std::string> watchdog_log;
  std::size_t programs = 0;

 private:
  void write_control(std::uint32_t value);
  void write_word(hal::Register& word, std::uint32_t value);
  std::uint32_t read_status();

  int keys_ = 0;
  bool dead_until_reset_ = false;
  int erasing_ = -1;
  double erase_left_ms_ = 0;
  double tick_phase_ms_ = 0;
};

}  // namespace hoof::tests
