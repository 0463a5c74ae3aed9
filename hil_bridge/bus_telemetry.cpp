#include "hil_bridge/bus_telemetry.h"

namespace hoof::bridge {

namespace protocol = firmware::protocol;
using firmware::control::DriveAction;
using protocol::DecodeResult;

namespace {

template <typename Message>
bool is(const hal::CanFrame& frame, Message& message) {
  return decode(frame, message) == DecodeResult::kOk;
}

}  // namespace

void BusTelemetry::take(const hal::CanFrame& frame, std::int64_t now_ns) {
  protocol::Sync sync;
  if (is(frame, sync)) {
    telemetry_.tick = sync.tick;
    telemetry_.time_ns = now_ns;
    return;
  }
  if (!take_drive(frame)) take_foot(frame);
}

bool BusTelemetry::take_drive(const hal::CanFrame& frame) {
  for (const protocol::Drive drive : protocol::kDrives) {
    const auto i = std::size_t(drive);
    protocol::DriveOrder order;
    if (decode_command(drive, frame, order) == DecodeResult::kOk) {
      auto& joint = telemetry_.verdict.joint[i];
      joint.action = DriveAction::kCommand;
      if (order.action) {
        const bool enters = *order.action == protocol::DriveSwitch::kEnter;
        joint.action = enters ? DriveAction::kEnter : DriveAction::kExit;
      }
      const protocol::DriveCommand& c = order.command;
      joint.command = {c.position_rad, c.velocity_rad_s, c.kp_Nm_rad, c.kd_Nm_s_rad, c.torque_Nm};
      if (drive == protocol::Drive::kHip) telemetry_.leg_set_point_rad.hip_rad = c.position_rad;
      if (drive == protocol::Drive::kKnee) telemetry_.leg_set_point_rad.knee_rad = c.position_rad;
      return true;
    }
    protocol::DriveReply reply;
    if (decode_reply(drive, frame, reply) == DecodeResult::kOk) {
      auto& state = telemetry_.state[i];
      state.reading_rad = reply.position_rad;
      // The toe's zero is found by homing and is on no wire; its angle comes with FootToe.
      if (drive != protocol::Drive::kToe) state.position_rad = reply.position_rad;
      state.velocity_rad_s = reply.velocity_rad_s;
      state.torque_Nm = reply.torque_Nm;
      state.temperature_C = reply.temperature_C;
      state.error = reply.error;
      state.received = true;
      return true;
    }
  }
  return false;
}

void BusTelemetry::take_foot(const hal::CanFrame& frame) {
  protocol::Heartbeat heartbeat;
  protocol::FootToe toe;
  protocol::FootLeg leg;
  protocol::FootGround ground;
  protocol::FootGate gate;
  protocol::FootCounters counters;
  firmware::app::Telemetry& t = telemetry_;
  if (is(frame, heartbeat)) {
    t.mode = firmware::control::Mode(heartbeat.mode);
    t.faults = heartbeat.faults;
  } else if (is(frame, toe)) {
    t.toe_set_point_rad = toe.commanded_rad;
    t.state[0].position_rad = toe.measured_rad;
    t.toe_moving = toe.moving;
  } else if (is(frame, leg)) {
    t.foot_m.x = leg.foot_x_m;
    t.foot_m.z = leg.foot_z_m;  // above the sand here, from the hip in the firmware's own
  } else if (is(frame, ground)) {
    t.phase_cycles = ground.phase_cycles;
    t.ground.sinkage_m = ground.sinkage_m;
    t.ground.force_N.x = ground.force_x_N;
    t.ground.force_N.z = ground.force_z_N;
    t.ground.contact = ground.contact;
  } else if (is(frame, gate)) {
    t.gate_interventions = gate.interventions;
    t.verdict.limits = {gate.toe_limits, gate.hip_limits, gate.knee_limits};
  } else if (is(frame, counters)) {
    t.counters.ticks = counters.ticks;
    t.counters.missed_ticks = counters.missed_ticks;
    t.counters.stale_syncs = counters.stale_syncs;
  }
}

}  // namespace hoof::bridge
