// What came in over the buses: decoded, checked, counted.
#pragma once

#include <array>
#include <optional>

#include "firmware/app/counters.h"
#include "firmware/control/types.h"
#include "firmware/protocol/codec.h"
#include "hal/can_bus.h"

namespace hoof::firmware::app {

/// An order frame as it came; a broken one is answered, too.
struct ReceivedOrder {
  protocol::DecodeResult result = protocol::DecodeResult::kOk;
  protocol::SupervisorOrder order;
};

class Inbox {
 public:
  explicit Inbox(Counters& counters);

  /// Takes every waiting frame. Replies are dated `now_ns`: the time of taking, on the local clock.
  void drain(hal::CanBus& bus, int bus_index, std::int64_t now_ns);

  /// Latest state of each joint, in joint angles.
  const control::PerJoint<control::JointState>& joints() const { return joints_; }

  // Each of these hands out what arrived since the last call.
  bool take_emergency_stop();
  /// The newest tick number that is not older than the last one handed out.
  std::optional<std::uint32_t> take_sync();
  std::optional<ReceivedOrder> take_order();

  /// The next SYNC may carry any number: the master may have started anew.
  void forget_sync() { last_tick_.reset(); }

  /// From now on joint angle = old joint angle - shift.
  void shift_zero(control::Joint joint, float shift_rad);
  float zero_rad(control::Joint joint) const { return zero_rad_[index(joint)]; }
  void set_referenced(control::Joint joint, bool known);

 private:
  static constexpr std::size_t kOrderQueue = 4;

  void take(const hal::CanFrame& frame, int bus_index, std::int64_t now_ns);
  void take_reply(protocol::Drive drive, const hal::CanFrame& frame, std::int64_t now_ns);
  void take_sync_frame(const hal::CanFrame& frame, int bus_index);
  void take_order_frame(const hal::CanFrame& frame);
  bool count(protocol::DecodeResult result);

  Counters& counters_;
  control::PerJoint<control::JointState> joints_{};
  control::PerJoint<float> zero_rad_{};
  bool emergency_stop_ = false;
  std::optional<std::uint32_t> sync_;
  std::optional<std::uint32_t> last_tick_;
  std::array<ReceivedOrder, kOrderQueue> orders_{};
  std::size_t order_count_ = 0;
};

}  // namespace hoof::firmware::app
