// What each order means for the controller, and what its answer is.
#pragma once

#include <cstdint>

#include "firmware/app/inbox.h"
#include "firmware/app/ownership.h"
#include "firmware/control/foot_controller.h"
#include "firmware/protocol/messages.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::app {

/// Orders of connected supervisors, by the rules of Ownership; but anybody may stop.
class OrderDesk {
 public:
  OrderDesk(control::FootController& controller, safety::TorqueGate& gate, Ownership& ownership)
      : controller_(controller), gate_(gate), ownership_(ownership) {}

  /// Carries the order out, or refuses it; the answer is to be sent to the supervisor.
  /// @param synced SYNC is coming; without it nothing is begun
  protocol::OrderAcknowledge handle(const ReceivedOrder& received, bool synced,
                                    std::int64_t now_ns);

  /// Connects the supervisor, or refuses it for its dictionary.
  protocol::OrderAcknowledge handle(const protocol::SupervisorConnect& connect,
                                    std::int64_t now_ns);

 private:
  protocol::OrderAcknowledge answer(protocol::OrderResult result, std::uint8_t supervisor_id,
                                    std::uint8_t counter) const;
  protocol::OrderResult judge(const ReceivedOrder& received, bool synced, std::int64_t now_ns);
  protocol::OrderResult stop(const protocol::SupervisorOrder& order, std::int64_t now_ns);
  protocol::OrderResult carry_out(const protocol::SupervisorOrder& order, bool synced);
  protocol::OrderResult reset();

  control::FootController& controller_;
  safety::TorqueGate& gate_;
  Ownership& ownership_;
};

}  // namespace hoof::firmware::app
