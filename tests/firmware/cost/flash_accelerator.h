// Wait cycles of the flash of an STM32F405 behind its accelerator: caches of whole lines, least
// recently used first out, and a prefetch of the line after the one that is executed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/firmware/cost/cycle_rule.h"

namespace hoof::tests::cost {

class FlashAccelerator {
 public:
  FlashAccelerator() { clear(); }

  // As after a reset, or after other code has been running: nothing is cached.
  void clear() {
    instructions_.assign(kFlashRule.instruction_lines, kNone);
    data_.assign(kFlashRule.data_lines, kNone);
    line_ = kNone;
    since_ = 0;
  }

  // Wait cycles before the instruction at `address` can be decoded.
  std::uint32_t fetch(std::uint32_t address) {
    const std::uint32_t line = address / kFlashRule.line_bytes;
    if (line == line_) return 0;
    const bool next = line == line_ + 1;
    // The prefetch of the next line began when the current one was entered.
    const std::uint32_t spent = next ? since_ : 1;
    line_ = line;
    since_ = 0;
    if (touch(instructions_, line)) return 0;
    return spent < kFlashRule.line_cycles ? kFlashRule.line_cycles - spent : 0;
  }

  // Wait cycles of a load of a constant in flash.
  std::uint32_t load(std::uint32_t address) {
    return touch(data_, address / kFlashRule.line_bytes) ? 0 : kFlashRule.line_cycles - 1;
  }

  void spend(std::uint32_t cycles) { since_ += cycles; }

 private:
  static constexpr std::uint32_t kNone = ~0u - 1;

  // Moves the line to the front. False when it was not there.
  static bool touch(std::vector<std::uint32_t>& lines, std::uint32_t line) {
    auto at = std::find(lines.begin(), lines.end(), line);
    const bool found = at != lines.end();
    if (!found) *--at = line;
    std::rotate(lines.begin(), at, at + 1);
    return found;
  }

  std::vector<std::uint32_t> instructions_;
  std::vector<std::uint32_t> data_;
  std::uint32_t line_ = kNone;
  std::uint32_t since_ = 0;
};

}  // namespace hoof::tests::cost
