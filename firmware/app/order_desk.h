// Who may give orders, in which sequence, and what each order means for the controller.
#pragma once

#include <cstdint>

#include "firmware/app/inbox.h"
#include "firmware/control/foot_controller.h"
#include "firmware/protocol/messages.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::app {

/// One supervisor owns the foot from its first accepted order until it releases it, or until the
/// foot is idle and the owner has been silent for a second. Others are refused, except to stop:
/// anybody may stop. Every order must carry the expected counter, told in each acknowledge, so that
/// a repeated, replayed or reordered frame does nothing.
class OrderDesk {
 public:
  static constexpr std::int64_t kLease_ns = 1'000'000'000;

  OrderDesk(control::FootController& controller, safety::TorqueGate& gate)
      : controller_(controller), gate_(gate) {}

  /// Carries the order out, or refuses it; the answer is to be sent to the supervisor.
  protocol::OrderAcknowledge handle(const ReceivedOrder& received, std::int64_t now_ns);

  std::uint8_t owner_id() const { return owner_id_; }

 private:
  protocol::OrderResult judge(const ReceivedOrder& received, std::int64_t now_ns);
  protocol::OrderResult carry_out(const protocol::SupervisorOrder& order);
  protocol::OrderResult reset();
  bool may_order(const protocol::SupervisorOrder& order, std::int64_t now_ns) const;

  control::FootController& controller_;
  safety::TorqueGate& gate_;
  std::uint8_t owner_id_ = 0;  // 0: nobody
  std::int64_t heard_ns_ = 0;  // last accepted order of the owner
  std::uint8_t expected_counter_ = 0;
};

}  // namespace hoof::firmware::app
