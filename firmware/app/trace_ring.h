// The last ticks before a fault, kept in RAM until one happens.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "firmware/control/types.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::app {

/// What the foot looked like in one tick.
struct TraceSample {
  std::uint32_t tick = 0;  // number of the SYNC
  control::FaultBits faults = 0;
  control::Mode mode = control::Mode::kOff;
  safety::LimitBits active_limits = 0;
  control::PerJoint<float> position_rad{};
  control::PerJoint<float> velocity_rad_s{};
  control::PerJoint<float> torque_Nm{};  // as the drives report it

  friend bool operator==(const TraceSample&, const TraceSample&) = default;
};

class TraceRing {
 public:
  /// A silence is called after 20 ms; four ticks before it show what the joint was doing.
  static constexpr std::size_t kTicks = 24;

  void put(const TraceSample& sample) {
    samples_[next_] = sample;
    next_ = (next_ + 1) % kTicks;
    if (count_ < kTicks) ++count_;
  }

  std::size_t count() const { return count_; }
  /// @param age 0 the newest; below count()
  const TraceSample& newest(std::size_t age) const {
    return samples_[(next_ + kTicks - 1 - age) % kTicks];
  }

 private:
  std::array<TraceSample, kTicks> samples_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace hoof::firmware::app
