#include "hil_bridge/drive_node.h"

namespace hoof::bridge {

namespace protocol = firmware::protocol;
using protocol::DriveSwitch;

void DriveNode::poll() {
  hal::CanFrame frame;
  while (bus_.receive(frame)) take(frame);
}

void DriveNode::take(const hal::CanFrame& frame) {
  if (frame.id != command_spec(which_).id) return;  // for somebody else
  protocol::DriveOrder order;
  if (decode_command(which_, frame, order) != protocol::DecodeResult::kOk) {
    ++malformed_;
    return;
  }
  ++commands_;
  obey(order);
  answer();
}

void DriveNode::obey(const protocol::DriveOrder& order) {
  if (order.action == DriveSwitch::kEnter) {
    // Repeated enter frames must not start an entered drive anew.
    if (!drive_.enabled()) drive_.enable();
  } else if (order.action == DriveSwitch::kExit) {
    drive_.disable();
  } else if (order.action == DriveSwitch::kSetZero) {
    drive_.zero();
  } else if (drive_.enabled()) {
    const protocol::DriveCommand& c = order.command;
    drive_.command({c.position_rad, c.velocity_rad_s, c.kp_Nm_rad, c.kd_Nm_s_rad, c.torque_Nm});
  }
}

void DriveNode::answer() {
  const sim::DriveReading now = drive_.reading();
  protocol::DriveReply reply;
  reply.position_rad = static_cast<float>(now.position_rad);
  reply.velocity_rad_s = static_cast<float>(now.velocity_rad_s);
  reply.torque_Nm = static_cast<float>(now.torque_Nm);
  reply.temperature_C = static_cast<float>(now.temperature_C);
  reply.error = static_cast<std::uint8_t>(now.error);  // same codes as the reply's table
  if (bus_.send(encode_reply(which_, reply)) != hal::SendResult::kQueued) ++unsent_;
}

}  // namespace hoof::bridge
