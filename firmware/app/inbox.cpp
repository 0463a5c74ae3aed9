#include "firmware/app/inbox.h"

namespace hoof::firmware::app {

using control::Joint;
using control::JointState;
using protocol::DecodeResult;
using protocol::Message;

static_assert(control::kJointCount == protocol::kDriveCount);

Inbox::Inbox(Counters& counters) : counters_(counters) {
  // Hip and knee have absolute encoders; the toe drive counts from where it woke up.
  set_referenced(Joint::kHip, true);
  set_referenced(Joint::kKnee, true);
}

void Inbox::drain(hal::CanBus& bus, int bus_index, std::int64_t now_ns) {
  while (bus.receive(frame_)) take(frame_, bus_index, now_ns);
}

void Inbox::take(const hal::CanFrame& frame, int bus_index, std::int64_t now_ns) {
  const bool standard = !frame.extended && !frame.error;
  if (standard && frame.id == spec(Message::kEmergencyStop).id) {
    emergency_stop_ = true;  // by the identifier alone: any doubt stops
    protocol::EmergencyStop press;
    count(decode(frame, press));
    return;
  }
  const auto bus = static_cast<protocol::BusMask>(1 << bus_index);
  const auto is = [&](const protocol::MessageSpec& message) {
    return frame.id == message.id && (message.buses & bus) != 0;
  };
  if (is(spec(Message::kSync))) return take_sync_frame(frame, bus_index);
  if (is(spec(Message::kSupervisorOrder))) return take_order_frame(frame);
  if (is(spec(Message::kSupervisorConnect))) return take_into(connects_, frame);
  if (is(spec(Message::kServiceRequest))) return take_into(requests_, frame);
  if (is(spec(Message::kParameterWrite))) return take_into(writes_, frame);
  for (const protocol::Drive drive : protocol::kDrives) {
    if (is(protocol::reply_spec(drive))) return take_reply(drive, frame, now_ns);
  }
  ++counters_.unknown_frames;
}

bool Inbox::count(DecodeResult result) {
  switch (result) {
    case DecodeResult::kOk:
      ++counters_.frames;
      return true;
    case DecodeResult::kBadCrc:
      ++counters_.bad_crc_frames;
      return false;
    case DecodeResult::kWrongIdentifier:
    case DecodeResult::kWrongFormat:
    case DecodeResult::kWrongLength:
      ++counters_.malformed_frames;
      return false;
  }
  return false;
}

void Inbox::take_reply(protocol::Drive drive, const hal::CanFrame& frame, std::int64_t now_ns) {
  protocol::DriveReply reply;
  if (!count(decode_reply(drive, frame, reply))) return;
  JointState& joint = joints_[index(drive)];
  joint.reading_rad = reply.position_rad;
  joint.position_rad = reply.position_rad - zero_rad_[index(drive)];
  joint.velocity_rad_s = reply.velocity_rad_s;
  joint.torque_Nm = reply.torque_Nm;
  joint.temperature_C = reply.temperature_C;
  joint.error = reply.error;
  joint.received = true;
  joint.received_ns = now_ns;
}

/// Bus 0 gives the beat; the SYNC of bus 1 is for the nodes there.
void Inbox::take_sync_frame(const hal::CanFrame& frame, int bus_index) {
  protocol::Sync sync;
  if (!count(decode(frame, sync)) || bus_index != 0) return;
  if (last_tick_) {
    const auto advance = static_cast<std::int32_t>(sync.tick - *last_tick_);
    if (advance <= 0) {
      ++counters_.stale_syncs;
      return;
    }
    // Numbers left out, and a tick already waiting that this one replaces.
    counters_.missed_ticks += static_cast<std::uint32_t>(advance - 1) + (sync_ ? 1u : 0u);
  }
  last_tick_ = sync.tick;
  sync_ = sync.tick;
}

void Inbox::take_order_frame(const hal::CanFrame& frame) {
  ReceivedOrder received;
  received.result = decode(frame, received.order);
  count(received.result);
  const bool answerable =
      received.result == DecodeResult::kOk || received.result == DecodeResult::kBadCrc;
  if (answerable) orders_.put(received);  // an order without answer is repeated
}

/// A broken one is not answered: it may be anybody's.
template <typename M>
void Inbox::take_into(Queue<M>& queue, const hal::CanFrame& frame) {
  M message;
  if (count(decode(frame, message))) queue.put(message);
}

bool Inbox::take_emergency_stop() {
  const bool stop = emergency_stop_;
  emergency_stop_ = false;
  return stop;
}

std::optional<std::uint32_t> Inbox::take_sync() {
  const std::optional<std::uint32_t> tick = sync_;
  sync_.reset();
  return tick;
}

void Inbox::set_zero(Joint joint, float zero_rad) {
  zero_rad_[index(joint)] = zero_rad;
  JointState& state = joints_[index(joint)];
  if (state.received) state.position_rad = state.reading_rad - zero_rad;
}

void Inbox::set_referenced(Joint joint, bool known) {
  joints_[index(joint)].referenced = known;
}

}  // namespace hoof::firmware::app
