// The supply of board and drives.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"

namespace hoof::firmware::safety {

/// The drives are made for 48 V. At 36 V, three quarters, the legs' speed-torque line has shrunk to
/// 712 Nm of stall and 8.7 rad/s without load: at the 5 rad/s that the gate allows it still gives
/// 303 Nm, at the 1.8 rad/s of the fastest path all of their 317; below, the drives no longer do
/// what the gate reckons with. It is also 3.0 V a cell of twelve, where a lithium battery takes
/// harm.
inline constexpr float kLowestSupply_V = 36.0f;

class SupplyWatch {
 public:
  /// Once per tick. One low tick is a spike of the motors' current, two are a supply that sags.
  /// @param low the board's early warning
  /// @param supply_V 0 where it is not measured
  /// @return kBrownOut with the second low tick in a row, and with each that follows it
  control::FaultBits note(bool low, float supply_V);

 private:
  bool was_low_ = false;
};

}  // namespace hoof::firmware::safety
