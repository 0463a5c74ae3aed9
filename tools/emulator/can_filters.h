// The 28 acceptance filter banks that CAN1 and CAN2 share.
//
// Source: RM0090 rev. 19, 32.7.4 and 32.9.5.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tools/emulator/peripheral.h"

namespace hoof::tools::emulator {

class CanFilters {
 public:
  static constexpr std::size_t kBanks = 28;

  struct Match {
    std::size_t fifo = 0;
    std::uint32_t index = 0;  // FMI: filters of the FIFO, counted over all of its banks
  };

  /// Offsets from the controller's base, 0x200 on. @return false where there is no such register
  bool read(std::uint32_t offset, std::uint32_t& value) const;
  bool write(std::uint32_t offset, std::uint32_t value);
  void reset();

  /// @param controller 0 for CAN1 @param identifier, remote and extended as in a mailbox's RIxR
  std::optional<Match> match(std::size_t controller, std::uint32_t identifier) const;

 private:
  bool changing() const { return (master_ & 1) != 0; }
  std::size_t first_of_can2() const { return master_ >> 8 & 0x3F; }
  static bool bit(std::uint32_t word, std::size_t i) { return (word >> i & 1) != 0; }
  std::uint32_t filters_in(std::size_t bank) const;
  std::optional<std::uint32_t> match_in(std::size_t bank, std::uint32_t identifier) const;

  std::uint32_t master_ = 0;  // FMR
  std::uint32_t list_mode_ = 0, wide_ = 0, fifo_ = 0, active_ = 0;
  std::array<std::array<std::uint32_t, 2>, kBanks> banks_{};
};

}  // namespace hoof::tools::emulator
