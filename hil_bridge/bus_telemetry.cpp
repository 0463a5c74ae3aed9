#include "hil_bridge/bus_telemetry.h"

#include "firmware/protocol/codec.h"
#include "firmware/protocol/dictionary.h"

namespace hoof::bridge {

using namespace firmware::protocol;

namespace {

bool ok(DecodeResult result) {
  return result == DecodeResult::kOk;
}

bool is_from_foot(const hal::CanFrame& frame) {
  if (frame.extended) return false;
  for (const MessageSpec& message : kMessages) {
    if (message.id == frame.id) return message.sender == Node::kFoot;
  }
  return false;
}

}  // namespace

void BusTelemetry::take(const hal::CanFrame& frame, std::int64_t now_ns) {
  if (is_from_foot(frame)) ++foot_frames_;
  telemetry_.time_ns = now_ns;
  if (take_drives(frame, now_ns) || take_status(frame)) return;
  take_measurements(frame);
}

bool BusTelemetry::take_drives(const hal::CanFrame& frame, std::int64_t now_ns) {
  for (const Drive drive : kDrives) {
    const std::size_t joint = index(drive);
    const float zero_rad = joint == 0 ? toe_zero_rad_ : 0.0f;
    if (DriveReply reply; ok(decode_reply(drive, frame, reply))) {
      auto& state = telemetry_.state[joint];
      state.reading_rad = reply.position_rad;
      state.position_rad = reply.position_rad - zero_rad;
      state.velocity_rad_s = reply.velocity_rad_s;
      state.torque_Nm = reply.torque_Nm;
      state.temperature_C = reply.temperature_C;
      state.error = reply.error;
      state.received = true;
      state.received_ns = now_ns;
      return true;
    }
    if (DriveOrder order; ok(decode_command(drive, frame, order))) {
      auto& command = telemetry_.verdict.joint[joint].command;
      command = {};
      if (order.action) return true;
      command.position_rad = order.command.position_rad - zero_rad;
      command.velocity_rad_s = order.command.velocity_rad_s;
      command.kp_Nm_rad = order.command.kp_Nm_rad;
      command.kd_Nm_s_rad = order.command.kd_Nm_s_rad;
      command.torque_Nm = order.command.torque_Nm;
      if (joint == 1) telemetry_.leg_set_point_rad.hip_rad = command.position_rad;
      if (joint == 2) telemetry_.leg_set_point_rad.knee_rad = command.position_rad;
      return true;
    }
  }
  return false;
}

bool BusTelemetry::take_status(const hal::CanFrame& frame) {
  if (Sync sync; ok(decode(frame, sync))) {
    telemetry_.tick = sync.tick;
  } else if (Heartbeat heartbeat; ok(decode(frame, heartbeat))) {
    telemetry_.mode = static_cast<firmware::control::Mode>(heartbeat.mode);
    telemetry_.faults = heartbeat.faults;
  } else if (OrderAcknowledge answer; ok(decode(frame, answer))) {
    telemetry_.mode = static_cast<firmware::control::Mode>(answer.mode);
  } else if (FootGate gate; ok(decode(frame, gate))) {
    telemetry_.gate_interventions = gate.interventions;
    telemetry_.verdict.limits = {gate.toe_limits, gate.hip_limits, gate.knee_limits};
  } else if (FootCounters counters; ok(decode(frame, counters))) {
    telemetry_.counters.ticks = counters.ticks;
    telemetry_.counters.missed_ticks = counters.missed_ticks;
    telemetry_.counters.stale_syncs = counters.stale_syncs;
  } else {
    return false;
  }
  return true;
}

void BusTelemetry::take_measurements(const hal::CanFrame& frame) {
  if (FootToe toe; ok(decode(frame, toe))) {
    telemetry_.toe_set_point_rad = toe.commanded_rad;
    telemetry_.toe_moving = toe.moving;
    auto& state = telemetry_.state[0];
    if (state.received) toe_zero_rad_ = state.reading_rad - toe.measured_rad;
    state.position_rad = toe.measured_rad;
  } else if (FootLeg leg; ok(decode(frame, leg))) {
    telemetry_.foot_m = {leg.foot_x_m, leg.foot_z_m};
  } else if (FootGround ground; ok(decode(frame, ground))) {
    telemetry_.phase_cycles = ground.phase_cycles;
    telemetry_.ground.sinkage_m = ground.sinkage_m;
    telemetry_.ground.force_N = {ground.force_x_N, ground.force_z_N};
    telemetry_.ground.contact = ground.contact;
  }
}

}  // namespace hoof::bridge
