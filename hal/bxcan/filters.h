// Acceptance filters of a pair of bxCAN controllers, which share the 28 banks of the first one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/bxcan/registers.h"

namespace hoof::hal::bxcan {

inline constexpr std::size_t kBanksPerController = kFilterBanks / 2;

/// While one of these lives, no frame is received by either controller. One bank per identifier, 32
/// bits with mask: standard format, data and remote frames alike, so that a remote frame under an
/// identifier of ours is seen and counted as the bad frame it is.
class FilterSetup {
 public:
  explicit FilterSetup(Registers& can1) : can1_(can1) {
    can1_.FMR.change(
        fmr::kFirstBankOfCan2Mask,
        fmr::kInitialisation | (std::uint32_t{kBanksPerController} << fmr::kFirstBankOfCan2Shift));
    can1_.FA1R.write(0);
    can1_.FM1R.write(0);                          // all banks: identifier and mask
    can1_.FS1R.write((1u << kFilterBanks) - 1u);  // all banks: one filter of 32 bits
    can1_.FFA1R.write(0);
  }
  ~FilterSetup() { can1_.FMR.clear(fmr::kInitialisation); }
  FilterSetup(const FilterSetup&) = delete;
  FilterSetup& operator=(const FilterSetup&) = delete;

  /// @param controller 0 for CAN1, 1 for CAN2
  /// @return false when its 14 banks are used up
  bool accept(std::size_t controller, std::uint32_t standard_id, std::size_t fifo) {
    if (used_[controller] == kBanksPerController) return false;
    const std::size_t bank = controller * kBanksPerController + used_[controller]++;
    can1_.filter[bank].first.write(standard_id << identifier::kStandardShift);
    can1_.filter[bank].second.write((0x7FFu << identifier::kStandardShift) | identifier::kExtended);
    if (fifo == 1) can1_.FFA1R.set(1u << bank);
    can1_.FA1R.set(1u << bank);
    return true;
  }

 private:
  Registers& can1_;
  std::array<std::size_t, 2> used_{};
};

}  // namespace hoof::hal::bxcan
