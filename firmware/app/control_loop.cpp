#include "firmware/app/control_loop.h"

#include "firmware/app/dictionary_agreement.h"
#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::firmware::app {

using control::DriveAction;
using control::FaultBits;
using control::Joint;
using control::JointWish;
using control::Mode;
namespace fault = control::fault;

namespace {

constexpr std::int64_t kTick_ns = 1'000'000;
constexpr std::int64_t kHeartbeatPeriod_ns =
    protocol::spec(protocol::Message::kHeartbeat).cycle_ms * kTick_ns;
constexpr std::int64_t kHeartbeatShortest_ns =
    protocol::spec(protocol::Message::kHeartbeat).shortest_ms * kTick_ns;

constexpr std::size_t bus_of(std::size_t joint) {
  return (protocol::command_spec(protocol::kDrives[joint]).buses & protocol::kBus0) != 0 ? 0 : 1;
}

protocol::DriveCommand on_wire(control::JointCommand command, float zero_rad) {
  return {command.position_rad + zero_rad, command.velocity_rad_s, command.kp_Nm_rad,
          command.kd_Nm_s_rad, command.torque_Nm};
}

hal::CanFrame frame_for(protocol::Drive drive, const JointWish& wish, float zero_rad) {
  switch (wish.action) {
    case DriveAction::kCommand:
      return encode_command(drive, on_wire(wish.command, zero_rad));
    case DriveAction::kEnter:
      return encode_switch(drive, protocol::DriveSwitch::kEnter);
    case DriveAction::kExit:
      break;
  }
  return encode_switch(drive, protocol::DriveSwitch::kExit);
}

}  // namespace

ControlLoop::ControlLoop(Buses buses, const hal::Clock& clock, const Parameters& parameters)
    : buses_(buses),
      clock_(clock),
      inbox_(counters_),
      controller_(parameters.control, parameters.presence()),
      gate_(parameters.presence()),
      orders_(controller_, gate_) {}

void ControlLoop::poll() {
  const std::int64_t now_ns = clock_.now_ns();
  watch_sync(now_ns);
  read(now_ns);
  answer_orders(now_ns);
  run_due_tick(now_ns);
  send_heartbeat_if_due(now_ns);
  outbox_.flush(*buses_[0]);
}

/// Before anything is read: frames that waited while this loop was not called must not hide that it
/// was not.
void ControlLoop::watch_sync(std::int64_t now_ns) {
  if (!synced_ || now_ns - last_sync_ns_ <= safety::kFreshness_ns) return;
  synced_ = false;
  inbox_.forget_sync();
  const Mode mode = controller_.mode();
  if (mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning ||
      mode == Mode::kDampedStop) {
    trip(fault::kSyncLost);
  }
}

/// Both buses are emptied before a tick runs: the replies on bus 1 belong to the SYNC on bus 0.
void ControlLoop::read(std::int64_t now_ns) {
  inbox_.drain(*buses_[1], 1, now_ns);
  inbox_.drain(*buses_[0], 0, now_ns);
  if (!inbox_.take_emergency_stop()) return;
  emergency_stop();
  // Orders that came with it were given before anyone could know: a reset among them must not undo
  // the stop. Unanswered, they are sent again.
  while (inbox_.take_order()) ++counters_.refused_orders;
}

void ControlLoop::answer_orders(std::int64_t now_ns) {
  while (const std::optional<ReceivedOrder> received = inbox_.take_order()) {
    const protocol::OrderAcknowledge answer = orders_.handle(*received, now_ns);
    if (answer.result != protocol::OrderResult::kAccepted) ++counters_.refused_orders;
    queue(encode(answer));
  }
}

void ControlLoop::run_due_tick(std::int64_t now_ns) {
  if (const std::optional<std::uint32_t> number = inbox_.take_sync()) {
    synced_ = true;
    last_sync_ns_ = now_ns;
    telemetry_.tick = *number;
    tick(now_ns);
  } else if (!synced_ && controller_.mode() == Mode::kDampedStop &&
             now_ns - last_tick_ns_ >= kTick_ns) {
    tick(now_ns);  // the safe stop goes on by the local clock
  }
}

void ControlLoop::tick(std::int64_t now_ns) {
  ++counters_.ticks;
  last_tick_ns_ = now_ns;
  for (const hal::CanBus* bus : buses_) {
    if (bus->status().bus_off) trip(fault::kBusOff);
  }
  trip(gate_.inspect(inbox_.joints(), controller_.mode(), now_ns));
  const control::Wish& wish = controller_.step(inbox_.joints());
  const safety::Verdict& verdict = gate_.check(wish, inbox_.joints());
  write(verdict.joint);
  trip(verdict.faults);
  if (controller_.faults() != 0) gate_.latch();
  record(now_ns);
  adopt_toe_zero();
  send_telemetry();
}

/// Where the toe's zero was just found, angles count from there with the next tick; where it became
/// doubtful, travel limits no longer apply to it until homed again.
void ControlLoop::adopt_toe_zero() {
  if (const std::optional<float> zero_rad = controller_.new_toe_zero_rad()) {
    inbox_.shift_zero(Joint::kToe, *zero_rad);
  }
  inbox_.set_referenced(Joint::kToe, controller_.homed());
}

void ControlLoop::write(const control::PerJoint<JointWish>& joints) {
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    if (!controller_.presence().has(i)) continue;
    const float zero_rad = inbox_.zero_rad(static_cast<Joint>(i));
    const hal::CanFrame frame = frame_for(protocol::kDrives[i], joints[i], zero_rad);
    if (buses_[bus_of(i)]->send(frame) != hal::SendResult::kQueued) ++counters_.unsent_frames;
  }
}

void ControlLoop::trip(FaultBits faults) {
  if (faults == 0) return;
  controller_.trip(faults);
  gate_.latch();
}

/// Not at the next tick: now.
void ControlLoop::emergency_stop() {
  controller_.emergency_stop();
  gate_.emergency_stop();
  write({});
}

void ControlLoop::record(std::int64_t now_ns) {
  Telemetry& t = telemetry_;
  t.time_ns = now_ns;
  t.mode = controller_.mode();
  t.faults = controller_.faults();
  t.state = inbox_.joints();
  t.verdict = gate_.verdict();
  t.wish = controller_.wish();
  t.homed = controller_.homed();
  t.toe_target_rad = controller_.toe().target_rad();
  t.toe_set_point_rad = controller_.toe().set_point_rad();
  t.toe_moving = controller_.toe().moving();
  const control::LegMotion& leg = controller_.leg();
  t.leg_set_point_rad = leg.set_point_rad();
  t.foot_set_point_m = leg.kinematics().foot_m(leg.set_point_rad());
  const control::LegAngles measured{t.state[index(Joint::kHip)].position_rad,
                                    t.state[index(Joint::kKnee)].position_rad};
  t.foot_m = leg.kinematics().foot_m(measured);
  t.foot_pitch_rad = leg.foot_pitch_rad(measured);
  t.phase_cycles = leg.path().phase_cycles();
  t.gait_rate_Hz = leg.path().rate_Hz();
  t.ground = controller_.ground();
  t.gate_interventions = gate_.interventions();
  t.counters = counters_;
}

/// One frame per tick at most, each in a slot of its own, so that a node with three mailboxes never
/// has to let its drive command wait.
void ControlLoop::send_telemetry() {
  const Telemetry& t = telemetry_;
  const bool leg = controller_.presence().leg;
  const control::JointState& toe = t.state[index(Joint::kToe)];
  switch (counters_.ticks % 10) {
    case 1:
      return queue(encode(protocol::FootToe{t.toe_set_point_rad, toe.position_rad, toe.torque_Nm,
                                            toe.temperature_C, t.toe_moving}));
    case 3:
      if (!leg) return;
      return queue(encode(protocol::FootLeg{t.state[index(Joint::kHip)].position_rad,
                                            t.state[index(Joint::kKnee)].position_rad, t.foot_m.x,
                                            t.foot_m.z + controller_.hip_above_sand_m()}));
    case 5:
      if (!leg) return;
      return queue(
          encode(protocol::FootGround{t.phase_cycles, t.ground.sinkage_m, t.ground.force_N.x,
                                      t.ground.force_N.z, t.ground.contact}));
    case 7:
      return queue(encode(protocol::FootGate{t.gate_interventions, t.verdict.limits[0],
                                             t.verdict.limits[1], t.verdict.limits[2]}));
    case 9:
      if (counters_.ticks % 100 != 9) return;
      return queue(encode(protocol::FootCounters{
          counters_.ticks, static_cast<std::uint16_t>(counters_.missed_ticks),
          static_cast<std::uint16_t>(counters_.stale_syncs)}));
    default:
      return;
  }
}

void ControlLoop::send_heartbeat_if_due(std::int64_t now_ns) {
  const protocol::Heartbeat now{static_cast<protocol::Mode>(controller_.mode()),
                                static_cast<std::uint8_t>((heartbeat_.counter + 1) & 0xF),
                                controller_.faults(), protocol::kHeartbeatHash};
  const bool changed = now.mode != heartbeat_.mode || now.faults != heartbeat_.faults;
  const std::int64_t age_ns = now_ns - heartbeat_ns_;
  const std::int64_t due_ns = changed ? kHeartbeatShortest_ns : kHeartbeatPeriod_ns;
  if (heartbeat_sent_ && age_ns < due_ns) return;
  heartbeat_ = now;
  heartbeat_ns_ = now_ns;
  heartbeat_sent_ = true;
  queue(encode(now));
}

void ControlLoop::queue(const hal::CanFrame& frame) {
  if (!outbox_.put(frame)) ++counters_.unsent_frames;
}

}  // namespace hoof::firmware::app
