// The last word before the bus: lets a wish through, clips it, or refuses it, and says why.
#pragma once

#include <cstdint>

#include "firmware/control/types.h"
#include "firmware/safety/heat.h"
#include "firmware/safety/limits.h"
#include "firmware/safety/reply_watch.h"

namespace hoof::firmware::safety {

/// Why a joint's command is not what was wished; one bit each.
using LimitBits = std::uint16_t;  // twelve at most
namespace limit {
inline constexpr LimitBits kTorque = 1u << 0;
inline constexpr LimitBits kTorqueRate = 1u << 1;
inline constexpr LimitBits kDistance = 1u << 2;
inline constexpr LimitBits kTravel = 1u << 3;
inline constexpr LimitBits kVelocity = 1u << 4;
inline constexpr LimitBits kGain = 1u << 5;
inline constexpr LimitBits kRefused = 1u << 6;  // not on the allow-list of the mode
inline constexpr LimitBits kLatched = 1u << 7;  // replaced by damping after a fault
/// The ceiling that a warm winding leaves.
inline constexpr LimitBits kOverload = 1u << 8;
}  // namespace limit

struct Verdict {
  control::PerJoint<control::JointWish> joint{};  // what goes to the drives
  control::PerJoint<LimitBits> limits{};
  control::PerJoint<float> torque_Nm{};  // expected of each drive now
  control::FaultBits faults = 0;         // a wish that is not a number

  LimitBits active_limits() const {
    LimitBits all = 0;
    for (const LimitBits bits : limits) all |= bits;
    return all;
  }
};

/// Knows nothing of gaits: a wish is judged by the mode's allow-list, the compiled ceilings, the
/// torque it will make at the measured state, and the last verdict. A fault latches: from then on
/// nothing but damping or exit passes until reset().
class TorqueGate {
 public:
  explicit TorqueGate(control::JointPresence presence) : presence_(presence) {}

  /// Looks at the drives' replies, once per tick and before check(): freshness, drive errors,
  /// plausibility, travel, temperature, obedience. Nothing of that is expected of drives while the
  /// mode is off, emergency off or fault; their heat is reckoned in every mode.
  /// @param ticks SYNC numbers since the last call, 1 unless some were missed
  /// @return faults found now (also latched)
  [[gnu::noinline]] control::FaultBits inspect(const control::PerJoint<control::JointState>& joints,
                                               control::Mode mode, std::int64_t now_ns,
                                               std::uint32_t ticks);

  /// Judges one wish, once per tick.
  [[gnu::noinline]] const Verdict& check(const control::Wish& wish,
                                         const control::PerJoint<control::JointState>& joints);

  /// Latches for a fault found elsewhere (SYNC lost, for one).
  void latch() { latched_ = true; }
  /// Exit frames only, until reset(): the e-stop frame, or an order.
  void emergency_stop() { emergency_ = latched_ = true; }
  /// State of the e-stop line, whenever it is read. Pressed stops as emergency_stop() does; let go
  /// lifts nothing, but only then may a reset.
  void emergency_line(bool pressed);
  bool emergency_pressed() const { return pressed_; }
  /// The deliberate reset order; never called by the firmware itself. Heat is not forgotten.
  /// @return false, and nothing is lifted, while the e-stop line is pressed
  bool reset();

  const Verdict& verdict() const { return verdict_; }
  bool latched() const { return latched_; }
  /// Joint commands changed or refused since start.
  std::uint32_t interventions() const { return interventions_; }
  /// Rise of the winding over its rise at the continuous torque; ceilings fall from 0.9 on.
  float heat_ratio(control::Joint joint) const { return heat_[index(joint)].ratio(); }

 private:
  control::FaultBits warm(std::size_t i, const control::JointState& state, std::int64_t now_ns,
                          std::int64_t elapsed_ns);
  void judge(std::size_t i, control::Mode mode, const control::JointWish& wish,
             const control::JointState& state);

  control::JointPresence presence_;
  bool latched_ = false;
  bool emergency_ = false;
  bool pressed_ = false;
  bool watching_ = false;
  std::int64_t inspected_ns_ = 0;
  control::PerJoint<ReplyWatch> replies_{};
  control::PerJoint<Heat> heat_{Heat{kDrives[0]}, Heat{kDrives[1]}, Heat{kDrives[2]}};
  Verdict verdict_;
  std::uint32_t interventions_ = 0;
};

}  // namespace hoof::firmware::safety
