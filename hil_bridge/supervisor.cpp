#include "hil_bridge/supervisor.h"

#include <span>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/dictionary.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::bridge {
namespace {

using namespace firmware::protocol;

constexpr std::int64_t kRepeat_ns = 20'000'000;  // an unanswered order is sent again after this

std::string name_of(std::span<const ValueName> names, std::uint32_t value) {
  for (const ValueName& n : names) {
    if (n.value == value) return std::string(n.name);
  }
  return std::to_string(value);
}

std::string fault_names(std::uint32_t faults) {
  std::string text;
  for (const ValueName& n : kFaultBitNames) {
    if (faults >> n.value & 1) text += (text.empty() ? "" : ", ") + std::string(n.name);
  }
  return text;
}

}  // namespace

void Supervisor::order(Order what, double toe_angle_rad, double frequency_Hz) {
  order_ = SupervisorOrder{id_, what, float(toe_angle_rad), float(frequency_Hz), counter_};
  accepted_ = false;
  sent_ = false;
  refusal_.clear();
}

void Supervisor::poll(std::int64_t now_ns) {
  hal::CanFrame frame;
  while (bus_.receive(frame)) take(frame);
  // Faults are no reason to be silent: reset is an order, too.
  if (!order_ || accepted_ || !refusal_.empty() || !heartbeat_) return;
  // One frame at a time: two with the same counter would have the same answer.
  if (awaiting_ && now_ns - sent_ns_ < kRepeat_ns) return;
  // A stop is anybody's, and does not wait to be introduced.
  if (connected_ || order_->order == Order::kStop) {
    send(now_ns);
  } else {
    send_connect(now_ns);
  }
}

void Supervisor::send_connect(std::int64_t now_ns) {
  const SupervisorConnect connect{id_, kProtocolHash, ++connect_counter_};
  if (bus_.send(encode(connect)) != hal::SendResult::kQueued) return;
  awaiting_ = true;
  connecting_ = true;
  sent_ns_ = now_ns;
}

void Supervisor::send(std::int64_t now_ns) {
  order_->counter = counter_;
  if (bus_.send(encode(*order_)) != hal::SendResult::kQueued) return;  // again at the next poll
  sent_ = true;
  awaiting_ = true;
  connecting_ = false;
  sent_counter_ = counter_;
  sent_ns_ = now_ns;
}

void Supervisor::take(const hal::CanFrame& frame) {
  if (OrderAcknowledge answer; decode(frame, answer) == DecodeResult::kOk) {
    take_acknowledge(answer);
  } else if (Heartbeat heartbeat; decode(frame, heartbeat) == DecodeResult::kOk) {
    take_heartbeat(heartbeat);
  } else if (FootToe toe; decode(frame, toe) == DecodeResult::kOk) {
    toe_ = toe;
  }
}

void Supervisor::take_acknowledge(const OrderAcknowledge& answer) {
  if (answer.supervisor_id != id_) return;
  counter_ = answer.expected_counter;
  mode_ = answer.mode;
  if (connecting_) return take_connection(answer);
  if (answer.counter != sent_counter_) return;
  awaiting_ = false;
  if (!order_ || accepted_ || !sent_) return;
  if (answer.result == OrderResult::kAccepted) {
    accepted_ = true;
  } else if (answer.result == OrderResult::kNotConnected) {
    connected_ = false;  // it lapsed; the order goes out again behind a new one
  } else if (answer.result != OrderResult::kBadCounter) {  // that one goes out again, mended
    refusal_ = "the order '" + name_of(kOrderNames, std::uint32_t(order_->order)) +
               "' was refused: " + name_of(kOrderResultNames, std::uint32_t(answer.result)) +
               " (mode " + name_of(kModeNames, std::uint32_t(answer.mode)) + ")";
  }
}

void Supervisor::take_connection(const OrderAcknowledge& answer) {
  if (answer.counter != connect_counter_) return;
  awaiting_ = false;
  connecting_ = false;
  connected_ = answer.result == OrderResult::kAccepted;
  if (!connected_) {
    refusal_ = "the firmware speaks another dictionary and refuses ours, whose protocol hash is " +
               std::to_string(kProtocolHash);
  }
}

void Supervisor::take_heartbeat(const Heartbeat& heartbeat) {
  if (heartbeat.protocol_hash != kHeartbeatHash) {
    heartbeat_.reset();
    refusal_ = "the firmware speaks another dictionary: its protocol hash is " +
               std::to_string(heartbeat.protocol_hash) + ", ours " + std::to_string(kHeartbeatHash);
    return;
  }
  heartbeat_ = heartbeat;
  mode_ = heartbeat.mode;
  faults_ = heartbeat.faults == 0 ? ""
                                  : "the firmware reports " + fault_names(heartbeat.faults) +
                                        " in mode " + name_of(kModeNames, std::uint32_t(*mode_));
}

}  // namespace hoof::bridge
