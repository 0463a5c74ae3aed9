#include "tools/emulator/can_filters.h"

namespace hoof::tools::emulator {
namespace {

enum Offset {
  kMaster = 0x200,
  kMode = 0x204,
  kScale = 0x20C,
  kAssignment = 0x214,
  kActivation = 0x21C,
  kFirstBank = 0x240
};
constexpr std::uint32_t kEnd = kFirstBank + 8 * CanFilters::kBanks;
constexpr std::uint32_t kAllBanks = (1u << CanFilters::kBanks) - 1;

/// An identifier as a filter of 16 bits sees it: STID, RTR, IDE, EXID 17 to 15.
std::uint32_t narrow(std::uint32_t identifier) {
  return (identifier >> 21 << 5) | (identifier >> 1 & 1) << 4 | (identifier >> 2 & 1) << 3 |
         (identifier >> 18 & 7);
}

}  // namespace

void CanFilters::reset() {
  *this = {};
  master_ = 0x2A1C'0E01;
}

bool CanFilters::read(std::uint32_t offset, std::uint32_t& value) const {
  switch (offset) {
    case kMaster:
      value = master_;
      return true;
    case kMode:
      value = list_mode_;
      return true;
    case kScale:
      value = wide_;
      return true;
    case kAssignment:
      value = fifo_;
      return true;
    case kActivation:
      value = active_;
      return true;
    default:
      break;
  }
  if (offset < kFirstBank || offset >= kEnd) return false;
  value = banks_[(offset - kFirstBank) / 8][(offset - kFirstBank) / 4 % 2];
  return true;
}

bool CanFilters::write(std::uint32_t offset, std::uint32_t value) {
  const auto set_while_changing = [&](std::uint32_t& target, const char* name) {
    if (!changing())
      throw EmulatorError(std::string("CAN1: ") + name + " written while filters run");
    target = value & kAllBanks;
    return true;
  };
  switch (offset) {
    case kMaster:
      master_ = (master_ & ~0x3F01u) | (value & 0x3F01u);
      return true;
    case kMode:
      return set_while_changing(list_mode_, "FM1R");
    case kScale:
      return set_while_changing(wide_, "FS1R");
    case kAssignment:
      return set_while_changing(fifo_, "FFA1R");
    case kActivation:
      active_ = value & kAllBanks;
      return true;
    default:
      break;
  }
  if (offset < kFirstBank || offset >= kEnd) return false;
  const std::size_t bank = (offset - kFirstBank) / 8;
  if (!changing() && bit(active_, bank)) {
    throw EmulatorError("CAN1: filter bank " + std::to_string(bank) +
                        " written while it is active");
  }
  banks_[bank][(offset - kFirstBank) / 4 % 2] = value;
  return true;
}

std::uint32_t CanFilters::filters_in(std::size_t bank) const {
  return (bit(wide_, bank) ? 1u : 2u) << (bit(list_mode_, bank) ? 1 : 0);
}

/// @return which of the bank's filters fits
std::optional<std::uint32_t> CanFilters::match_in(std::size_t bank,
                                                  std::uint32_t identifier) const {
  const auto& [first, second] = banks_[bank];
  const bool list = bit(list_mode_, bank);
  if (bit(wide_, bank)) {
    const std::uint32_t id = identifier & ~1u;
    if (!list) return ((id ^ first) & second & ~1u) == 0 ? std::optional(0u) : std::nullopt;
    if (id == (first & ~1u)) return 0;
    return id == (second & ~1u) ? std::optional(1u) : std::nullopt;
  }
  const std::uint32_t id = narrow(identifier);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const std::uint32_t low = banks_[bank][i] & 0xFFFF, high = banks_[bank][i] >> 16;
    if (!list && ((id ^ low) & high) == 0) return i;
    if (list && id == low) return 2 * i;
    if (list && id == high) return 2 * i + 1;
  }
  return std::nullopt;
}

/// The first that fits, by bank: the part's own order (wide before narrow, list before mask) only
/// decides which index is told.
std::optional<CanFilters::Match> CanFilters::match(std::size_t controller,
                                                   std::uint32_t identifier) const {
  if (changing()) return std::nullopt;
  std::array<std::uint32_t, 2> counted{};
  const std::size_t begin = controller == 0 ? 0 : first_of_can2();
  const std::size_t end = controller == 0 ? first_of_can2() : kBanks;
  for (std::size_t bank = begin; bank < end && bank < kBanks; ++bank) {
    const std::size_t fifo = bit(fifo_, bank) ? 1 : 0;
    if (bit(active_, bank)) {
      if (const auto found = match_in(bank, identifier)) return Match{fifo, counted[fifo] + *found};
    }
    counted[fifo] += filters_in(bank);
  }
  return std::nullopt;
}

}  // namespace hoof::tools::emulator
