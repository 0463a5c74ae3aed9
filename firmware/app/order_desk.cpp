#include "firmware/app/order_desk.h"

namespace hoof::firmware::app {

using control::Acceptance;
using protocol::Order;
using protocol::OrderResult;

namespace {

OrderResult result_of(Acceptance acceptance) {
  switch (acceptance) {
    case Acceptance::kAccepted:
      return OrderResult::kAccepted;
    case Acceptance::kOutOfRange:
      return OrderResult::kOutOfRange;
    case Acceptance::kWrongMode:
      return OrderResult::kWrongMode;
    case Acceptance::kNoLeg:
      return OrderResult::kNoLeg;
    case Acceptance::kNotCalibrated:
      return OrderResult::kNotCalibrated;
  }
  return OrderResult::kWrongMode;
}

OrderResult result_of(Ownership::Standing standing) {
  switch (standing) {
    case Ownership::Standing::kGranted:
      return OrderResult::kAccepted;
    case Ownership::Standing::kNotConnected:
      return OrderResult::kNotConnected;
    case Ownership::Standing::kNotOwner:
      return OrderResult::kNotOwner;
    case Ownership::Standing::kBadCounter:
      return OrderResult::kBadCounter;
  }
  return OrderResult::kNotOwner;
}

}  // namespace

protocol::OrderAcknowledge OrderDesk::handle(const ReceivedOrder& received, bool synced,
                                             std::int64_t now_ns) {
  const OrderResult result = judge(received, synced, now_ns);
  return answer(result, received.order.supervisor_id, received.order.counter);
}

protocol::OrderAcknowledge OrderDesk::handle(const protocol::SupervisorConnect& connect,
                                             std::int64_t now_ns) {
  const bool same = ownership_.connect(connect.supervisor_id, connect.protocol_hash, now_ns);
  return answer(same ? OrderResult::kAccepted : OrderResult::kOtherDictionary,
                connect.supervisor_id, connect.counter);
}

protocol::OrderAcknowledge OrderDesk::answer(OrderResult result, std::uint8_t supervisor_id,
                                             std::uint8_t counter) const {
  protocol::OrderAcknowledge answer;
  answer.result = result;
  answer.supervisor_id = supervisor_id;
  answer.counter = counter;
  answer.mode = static_cast<protocol::Mode>(controller_.mode());
  answer.expected_counter = ownership_.expected_counter();
  answer.owner_id = ownership_.owner_id();
  return answer;
}

OrderResult OrderDesk::judge(const ReceivedOrder& received, bool synced, std::int64_t now_ns) {
  if (received.result != protocol::DecodeResult::kOk) return OrderResult::kBadCrc;
  const protocol::SupervisorOrder& order = received.order;
  ownership_.hear(order.supervisor_id, now_ns);
  if (order.order == Order::kStop) return stop(order, now_ns);
  const Ownership::Standing standing =
      ownership_.judge(order.supervisor_id, order.counter, controller_.mode(), now_ns);
  if (standing != Ownership::Standing::kGranted) return result_of(standing);
  ownership_.count();
  const OrderResult result = carry_out(order, synced);
  if (result != OrderResult::kAccepted) return result;
  if (order.order == Order::kRelease) {
    ownership_.release();
  } else {
    ownership_.own(order.supervisor_id, now_ns);
  }
  return result;
}

/// Anybody may stop, connected or not; the owner stays the owner.
OrderResult OrderDesk::stop(const protocol::SupervisorOrder& order, std::int64_t now_ns) {
  if (order.supervisor_id == 0) return OrderResult::kNotOwner;
  if (order.counter != ownership_.expected_counter()) return OrderResult::kBadCounter;
  ownership_.count();
  const OrderResult result = result_of(controller_.order_stop());
  const bool free = ownership_.owner_id() == 0 && ownership_.connected(order.supervisor_id, now_ns);
  if (result == OrderResult::kAccepted && (free || ownership_.owner_id() == order.supervisor_id)) {
    ownership_.own(order.supervisor_id, now_ns);
  }
  return result;
}

OrderResult OrderDesk::carry_out(const protocol::SupervisorOrder& order, bool synced) {
  switch (order.order) {
    case Order::kReady:
    case Order::kRun:
      // Without SYNC nothing would move now; it must not begin to at some later time.
      if (!synced) return OrderResult::kNoSync;
      return result_of(order.order == Order::kReady
                           ? controller_.order_ready(order.toe_angle_rad)
                           : controller_.order_run(order.toe_angle_rad, order.frequency_Hz));
    case Order::kReset:
      return reset();
    case Order::kRelease:
      return OrderResult::kAccepted;
    case Order::kStop:
      break;  // done before
  }
  return OrderResult::kUnknownOrder;
}

OrderResult OrderDesk::reset() {
  if (gate_.emergency_pressed()) return OrderResult::kWrongMode;
  const OrderResult result = result_of(controller_.order_reset());
  if (result == OrderResult::kAccepted) gate_.reset();
  return result;
}

}  // namespace hoof::firmware::app
