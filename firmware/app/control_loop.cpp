#include "firmware/app/control_loop.h"

#include "firmware/app/dictionary_agreement.h"
#include "firmware/app/telemetry_frames.h"
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

ControlLoop::ControlLoop(Buses buses, const hal::Clock& clock, hal::Board& board,
                         const Parameters& parameters, Storage* storage, hal::ImageSlots* slots)
    : buses_(buses),
      clock_(clock),
      board_(board),
      storage_(storage),
      parameters_(parameters),
      inbox_(counters_),
      controller_(parameters.settings(), parameters.presence()),
      gate_(parameters.presence()),
      orders_(controller_, gate_, ownership_),
      update_(slots),
      services_(parameters_, storage, ownership_, inbox_, board.reset_cause(), &update_) {
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    inbox_.set_zero(static_cast<Joint>(i), parameters_.zero_rad(static_cast<Joint>(i)));
  }
  examine_start();
}

/// What the last run left behind: a person should know before anything moves.
void ControlLoop::examine_start() {
  FaultBits found = 0;
  const hal::ResetCause cause = board_.reset_cause();
  // But for a restart that it was told to do this firmware asks for a reset in its fault handlers
  // alone.
  const bool crashed = cause == hal::ResetCause::kSoftware;
  if (crashed || cause == hal::ResetCause::kWatchdog) found |= fault::kUnexpectedReset;
  if (cause == hal::ResetCause::kBrownOut) found |= fault::kBrownOut;
  if (storage_ != nullptr && storage_->doubtful()) found |= fault::kStorage;
  trip(found);
}

void ControlLoop::poll() {
  const std::int64_t now_ns = clock_.now_ns();
  mode_before_ = controller_.mode();
  cycle_.begin();
  watch_buses();
  watch_sync(now_ns);
  watch_button();
  read(now_ns);
  cycle_.passed(safety::Stage::kRead);
  if (inbox_.asked()) {
    answer_orders(now_ns);
    answer_services(now_ns);
  }
  run_due_tick(now_ns);
  watch_update(now_ns);
  send_exit_again();
  send_heartbeat_if_due(now_ns);
  outbox_.flush(*buses_[0]);
  keep_fault_log(now_ns);
  // A stop brakes with the damping of the drives; behind it, and in an e-stop, they get nothing.
  const Mode mode = controller_.mode();
  board_.allow_drives(mode != Mode::kEmergencyOff && mode != Mode::kFault);
  if (cycle_.finished()) board_.feed_watchdog();
}

/// At every poll: a bus that is off brings no SYNC, so no tick would notice it.
void ControlLoop::watch_buses() {
  for (const hal::CanBus* bus : buses_) {
    if (bus->bus_off()) trip(fault::kBusOff);
  }
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

/// The line of the e-stop button, at every poll. Pressed it stops once, not in every poll: the exit
/// frames would flood the bus.
void ControlLoop::watch_button() {
  const bool was_pressed = gate_.emergency_pressed();
  const bool pressed = board_.emergency_stop_pressed();
  gate_.emergency_line(pressed);
  if (pressed && !was_pressed) emergency_stop();
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
  const auto send = [this](const protocol::OrderAcknowledge& answer) {
    if (answer.result != protocol::OrderResult::kAccepted) ++counters_.refused_orders;
    queue(encode(answer));
  };
  while (const auto connect = inbox_.take_connect()) send(orders_.handle(*connect, now_ns));
  while (const auto order = inbox_.take_order()) {
    send(orders_.handle(*order, synced_, now_ns));
  }
}

void ControlLoop::answer_services(std::int64_t now_ns) {
  const auto send = [this](const protocol::ServiceAnswer& answer) {
    if (answer.result != protocol::ServiceResult::kDone) ++counters_.refused_orders;
    queue(encode(answer));
  };
  while (const auto write = inbox_.take_write()) {
    send(services_.handle(*write, controller_.mode(), now_ns));
  }
  while (const auto request = inbox_.take_request()) {
    send(services_.handle(*request, controller_.mode(), now_ns));
  }
  if (services_.take_changed()) adopt_parameters();
}

/// In mode off only: no drive is under torque. Which drives there are counts from the next start.
/// Apart, for its settings would else lie on the stack below everything that a service does.
[[gnu::noinline]] void ControlLoop::adopt_parameters() {
  controller_.configure(parameters_.settings(), controller_.presence());
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    const bool found_by_homing = joint == Joint::kToe && !parameters_.control.homing.is_absolute();
    if (found_by_homing && controller_.homed()) continue;
    inbox_.set_zero(joint, parameters_.zero_rad(joint));
  }
}

/// As a rule there is nothing to watch, and a poll costs.
void ControlLoop::watch_update(std::int64_t now_ns) {
  if (!update_.watches()) return;
  Health health;
  const Mode mode = controller_.mode();
  health.idle = mode == Mode::kOff || mode == Mode::kFault || mode == Mode::kEmergencyOff;
  health.faulty = controller_.faults() != 0;
  for (const hal::CanBus* bus : buses_) health.faulty = health.faulty || bus->status().bus_off;
  health.ticks = counters_.ticks;
  health.overruns = counters_.overruns;
  update_.poll(now_ns, health);
}

void ControlLoop::run_due_tick(std::int64_t now_ns) {
  std::uint32_t elapsed_ticks = 1;
  if (const std::optional<std::uint32_t> number = inbox_.take_sync()) {
    if (synced_) elapsed_ticks = *number - telemetry_.tick;
    synced_ = true;
    last_sync_ns_ = now_ns;
    telemetry_.tick = *number;
  } else if (synced_ || controller_.mode() != Mode::kDampedStop ||
             now_ns - last_tick_ns_ < kTick_ns) {
    return;  // but the safe stop goes on by the local clock
  }
  cycle_.tick_due();
  tick(now_ns, elapsed_ticks);
  trip(overrun_.note(now_ns, clock_.now_ns()));
  counters_.overruns = overrun_.overruns();
}

void ControlLoop::tick(std::int64_t now_ns, std::uint32_t elapsed_ticks) {
  ++counters_.ticks;
  last_tick_ns_ = now_ns;
  trip(supply_.note(board_.supply_low(), board_.supply_V()));
  trip(heat_.note(board_.temperature_C()));
  trip(gate_.inspect(inbox_.joints(), controller_.mode(), now_ns, elapsed_ticks));
  const control::Wish& wish = controller_.step(inbox_.joints());
  cycle_.passed(safety::Stage::kDecide);
  const safety::Verdict& verdict = gate_.check(wish, inbox_.joints());
  cycle_.passed(safety::Stage::kGate);
  write(verdict.joint);
  cycle_.passed(safety::Stage::kWrite);
  trip(verdict.faults);
  if (controller_.faults() != 0) gate_.latch();
  record(now_ns);
  trace();
  adopt_toe_zero();
  const auto frame =
      telemetry_frame(telemetry_, controller_.presence().leg, controller_.hip_above_sand_m());
  if (frame) queue(*frame);
}

/// Where the toe's zero was just found, angles count from there with the next tick; where it became
/// doubtful, travel limits no longer apply to it until homed again.
void ControlLoop::adopt_toe_zero() {
  if (const std::optional<float> zero_rad = controller_.new_toe_zero_rad()) {
    inbox_.set_zero(Joint::kToe, inbox_.zero_rad(Joint::kToe) + *zero_rad);
  }
  inbox_.set_referenced(Joint::kToe, controller_.homed());
}

void ControlLoop::write(const control::PerJoint<JointWish>& joints) {
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    if (!controller_.presence().has(i)) continue;
    const float zero_rad = inbox_.zero_rad(static_cast<Joint>(i));
    const hal::CanFrame frame = frame_for(protocol::kDrives[i], joints[i], zero_rad);
    hal::CanBus& bus = *buses_[bus_of(i)];
    bus.withdraw(frame.id);  // what a busy bus has kept from the tick before is out of date
    const bool sent = bus.send(frame) == hal::SendResult::kQueued;
    if (!sent) ++counters_.unsent_frames;
    exit_unsent_[i] = !sent && joints[i].action == DriveAction::kExit;
  }
  note_exit_unsent();
}

/// Exit frames that a full or dead bus refused must not wait for the next SYNC.
void ControlLoop::send_exit_again() {
  if (!some_exit_unsent_) return;
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    if (!exit_unsent_[i]) continue;
    const hal::CanFrame frame = encode_switch(protocol::kDrives[i], protocol::DriveSwitch::kExit);
    exit_unsent_[i] = buses_[bus_of(i)]->send(frame) != hal::SendResult::kQueued;
  }
  note_exit_unsent();
}

void ControlLoop::note_exit_unsent() {
  some_exit_unsent_ = false;
  for (const bool unsent : exit_unsent_) some_exit_unsent_ = some_exit_unsent_ || unsent;
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
  t.foot_set_point_m = leg.set_point().foot_m;
  t.foot_m = controller_.posture().foot_m;
  t.foot_pitch_rad = leg.foot_pitch_rad(controller_.posture().q);
  t.phase_cycles = leg.path().phase_cycles();
  t.gait_rate_Hz = leg.path().rate_Hz();
  t.ground = controller_.ground();
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    t.heat_ratio[i] = gate_.heat_ratio(static_cast<Joint>(i));
  }
  t.supply_V = board_.supply_V();
  t.gate_interventions = gate_.interventions();
  t.counters = counters_;
}

void ControlLoop::trace() {
  if (storage_ == nullptr) return;
  const Telemetry& t = telemetry_;
  TraceSample sample{.tick = t.tick,
                     .faults = t.faults,
                     .mode = t.mode,
                     .active_limits = t.verdict.active_limits()};
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    sample.position_rad[i] = t.state[i].position_rad;
    sample.velocity_rad_s[i] = t.state[i].velocity_rad_s;
    sample.torque_Nm[i] = t.state[i].torque_Nm;
  }
  storage_->fault_log().trace(sample);
}

/// New faults go to the log with the ticks before them; it is written a few words per millisecond,
/// SYNC or not. A button that is pressed often leaves half of the log to faults.
void ControlLoop::keep_fault_log(std::int64_t now_ns) {
  if (storage_ == nullptr) return;
  FaultLog& log = storage_->fault_log();
  const FaultBits faults = controller_.faults();
  const FaultBits fresh = faults & ~logged_faults_;
  logged_faults_ = faults;
  const bool pressed_again = fresh == fault::kEmergencyStop && 2 * log.used() >= log.capacity();
  if (fresh != 0 && !pressed_again) log.append(fresh, mode_before_, telemetry_.tick, now_ns);
  if (now_ns - log_step_ns_ < kTick_ns) return;
  log_step_ns_ = now_ns;
  log.step();
}

protocol::Heartbeat ControlLoop::next_heartbeat() const {
  return {static_cast<protocol::Mode>(controller_.mode()),
          static_cast<std::uint8_t>((heartbeat_.counter + 1) & 0xF), controller_.faults(),
          protocol::kHeartbeatHash};
}

std::int64_t ControlLoop::heartbeat_due_ns() const {
  if (!heartbeat_sent_) return heartbeat_ns_;
  const bool changed = static_cast<protocol::Mode>(controller_.mode()) != heartbeat_.mode ||
                       controller_.faults() != heartbeat_.faults;
  return heartbeat_ns_ + (changed ? kHeartbeatShortest_ns : kHeartbeatPeriod_ns);
}

void ControlLoop::send_heartbeat_if_due(std::int64_t now_ns) {
  if (heartbeat_sent_ && now_ns < heartbeat_due_ns()) return;
  const protocol::Heartbeat next = next_heartbeat();
  heartbeat_ = next;
  heartbeat_ns_ = now_ns;
  heartbeat_sent_ = true;
  queue(encode(next));
}

std::int64_t ControlLoop::next_due_ns() const {
  std::int64_t due_ns = heartbeat_due_ns();
  const auto sooner = [&due_ns](std::int64_t t_ns) {
    if (t_ns < due_ns) due_ns = t_ns;
  };
  if (waits_for_room()) sooner(0);
  if (synced_) {
    sooner(last_sync_ns_ + safety::kFreshness_ns + 1);
  } else if (controller_.mode() == Mode::kDampedStop) {
    sooner(last_tick_ns_ + kTick_ns);
  }
  if (update_.restart_pending()) sooner(0);
  if (storage_ != nullptr) sooner(log_step_ns_ + kTick_ns);
  return due_ns;
}

void ControlLoop::queue(const hal::CanFrame& frame) {
  if (!outbox_.put(frame)) ++counters_.unsent_frames;
}

}  // namespace hoof::firmware::app
