// What came in over the buses: decoded, checked, counted.
#pragma once

#include <optional>

#include "firmware/app/counters.h"
#include "firmware/app/fixed_queue.h"
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
  [[gnu::noinline]] void drain(hal::CanBus& bus, int bus_index, std::int64_t now_ns);

  /// Latest state of each joint, in joint angles.
  const control::PerJoint<control::JointState>& joints() const { return joints_; }

  // Each of these hands out what arrived since the last call.
  bool take_emergency_stop();
  /// The newest tick number that is not older than the last one handed out.
  std::optional<std::uint32_t> take_sync();
  /// Whether any of the next four has something.
  bool asked() const {
    return !orders_.empty() || !connects_.empty() || !requests_.empty() || !writes_.empty();
  }
  std::optional<ReceivedOrder> take_order() { return orders_.take(); }
  std::optional<protocol::SupervisorConnect> take_connect() { return connects_.take(); }
  std::optional<protocol::ServiceRequest> take_request() { return requests_.take(); }
  std::optional<protocol::ParameterWrite> take_write() { return writes_.take(); }

  /// The next SYNC may carry any number: the master may have started anew.
  void forget_sync() { last_tick_.reset(); }

  /// From now on joint angle = reading - zero.
  void set_zero(control::Joint joint, float zero_rad);
  float zero_rad(control::Joint joint) const { return zero_rad_[index(joint)]; }
  void set_referenced(control::Joint joint, bool known);

 private:
  /// More than one of a kind in a poll is a supervisor that does not wait for its answer.
  static constexpr std::size_t kQueue = 4;
  template <typename T>
  using Queue = FixedQueue<T, kQueue>;

  void take(const hal::CanFrame& frame, int bus_index, std::int64_t now_ns);
  void take_reply(protocol::Drive drive, const hal::CanFrame& frame, std::int64_t now_ns);
  void take_sync_frame(const hal::CanFrame& frame, int bus_index);
  void take_order_frame(const hal::CanFrame& frame);
  template <typename M>
  void take_into(Queue<M>& queue, const hal::CanFrame& frame);
  bool count(protocol::DecodeResult result);

  Counters& counters_;
  hal::CanFrame frame_;  // the one being taken
  control::PerJoint<control::JointState> joints_{};
  control::PerJoint<float> zero_rad_{};
  bool emergency_stop_ = false;
  std::optional<std::uint32_t> sync_;
  std::optional<std::uint32_t> last_tick_;
  Queue<ReceivedOrder> orders_;
  Queue<protocol::SupervisorConnect> connects_;
  Queue<protocol::ServiceRequest> requests_;
  Queue<protocol::ParameterWrite> writes_;
};

}  // namespace hoof::firmware::app
