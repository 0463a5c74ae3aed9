#include "firmware/app/order_desk.h"

namespace hoof::firmware::app {

using control::Acceptance;
using control::Mode;
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

bool is_idle(Mode mode) {
  return mode == Mode::kOff || mode == Mode::kEmergencyOff || mode == Mode::kFault;
}

}  // namespace

protocol::OrderAcknowledge OrderDesk::handle(const ReceivedOrder& received, std::int64_t now_ns) {
  protocol::OrderAcknowledge answer;
  answer.result = judge(received, now_ns);
  answer.supervisor_id = received.order.supervisor_id;
  answer.counter = received.order.counter;
  answer.mode = static_cast<protocol::Mode>(controller_.mode());
  answer.expected_counter = expected_counter_;
  answer.owner_id = owner_id_;
  return answer;
}

OrderResult OrderDesk::judge(const ReceivedOrder& received, std::int64_t now_ns) {
  if (received.result != protocol::DecodeResult::kOk) return OrderResult::kBadCrc;
  const protocol::SupervisorOrder& order = received.order;
  if (!may_order(order, now_ns)) return OrderResult::kNotOwner;
  if (order.counter != expected_counter_) return OrderResult::kBadCounter;
  ++expected_counter_;
  const OrderResult result = carry_out(order);
  if (result != OrderResult::kAccepted) return result;
  const bool stopped_by_other =
      owner_id_ != 0 && order.supervisor_id != owner_id_ && order.order == Order::kStop;
  if (stopped_by_other) return result;  // the owner stays the owner
  owner_id_ = order.order == Order::kRelease ? std::uint8_t{0} : order.supervisor_id;
  heard_ns_ = now_ns;
  return result;
}

bool OrderDesk::may_order(const protocol::SupervisorOrder& order, std::int64_t now_ns) const {
  if (order.supervisor_id == 0) return false;
  if (order.order == Order::kStop) return true;
  const bool lapsed = is_idle(controller_.mode()) && now_ns - heard_ns_ > kLease_ns;
  return owner_id_ == 0 || owner_id_ == order.supervisor_id || lapsed;
}

OrderResult OrderDesk::carry_out(const protocol::SupervisorOrder& order) {
  switch (order.order) {
    case Order::kStop:
      return result_of(controller_.order_stop());
    case Order::kReady:
      return result_of(controller_.order_ready(order.toe_angle_rad));
    case Order::kRun:
      return result_of(controller_.order_run(order.toe_angle_rad, order.frequency_Hz));
    case Order::kReset:
      return reset();
    case Order::kRelease:
      return OrderResult::kAccepted;
  }
  return OrderResult::kUnknownOrder;
}

OrderResult OrderDesk::reset() {
  const OrderResult result = result_of(controller_.order_reset());
  if (result == OrderResult::kAccepted) gate_.reset();
  return result;
}

}  // namespace hoof::firmware::app
