#include "firmware/safety/supply.h"

namespace hoof::firmware::safety {

control::FaultBits SupplyWatch::note(bool low, float supply_V) {
  const bool enough = supply_V == 0.0f || supply_V >= kLowestSupply_V;  // false for not-a-number
  const bool is_low = low || !enough;
  const bool sags = is_low && was_low_;
  was_low_ = is_low;
  return sags ? control::fault::kBrownOut : 0;
}

}  // namespace hoof::firmware::safety
