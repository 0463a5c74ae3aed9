#include "tests/fuzz/loop_watch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "firmware/app/crc32.h"
#include "firmware/safety/command_limits.h"
#include "firmware/safety/limits.h"
#include "tests/fuzz/require.h"

namespace hoof::tests::fuzz {

using namespace firmware;
using app::ControlLoop;
using control::Mode;
using protocol::DecodeResult;
using protocol::Drive;
namespace fault = control::fault;

namespace {

/// Rounding of positions up to 3.2 rad (one float step 2.4e-7) times 20000 Nm/rad, twice.
constexpr float kRounding_Nm = 0.01f;

bool is_moving(Mode mode) {
  return mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning;
}

bool is_latched(Mode mode) {
  return mode == Mode::kEmergencyOff || mode == Mode::kFault;
}

/// How far the torque of a packed command may be from that of the command: half a code each, and a
/// hundredth for the rounding of the value itself.
float packing_error_Nm(Drive drive, const protocol::DriveCommand& c,
                       const protocol::DriveReply& measured) {
  const auto& signals = protocol::kCommandSignals[index(drive)];
  const auto half = [&](std::size_t i) { return 0.51f * signals[i].scale; };
  return c.kp_Nm_rad * half(0) + c.kd_Nm_s_rad * half(1) +
         half(2) * std::abs(c.position_rad - measured.position_rad) +
         half(3) * std::abs(c.velocity_rad_s - measured.velocity_rad_s) + half(4);
}

std::uint32_t crc_of(const app::Parameters& parameters) {
  app::Parameters copy = parameters;
  app::Crc32 crc;
  for (const app::ParameterEntry& entry : app::parameter_table()) {
    const std::array<std::uint32_t, 1> word{std::bit_cast<std::uint32_t>(entry.value(copy))};
    crc.add(word);
  }
  return crc.value();
}

const protocol::MessageSpec* find_sent(const hal::CanFrame& frame, std::size_t bus) {
  for (const protocol::MessageSpec& message : protocol::kMessages) {
    const bool ours = message.sender == protocol::Node::kFoot && (message.buses >> bus & 1u) != 0;
    if (ours && message.id == frame.id) return &message;
  }
  return nullptr;
}

}  // namespace

void LoopWatch::before(Buses buses, const ControlLoop& loop, std::int64_t now_ns) {
  buses_ = buses;
  now_ns_ = now_ns;
  heard_ = {};
  mode_before_ = loop.mode();
  faults_before_ = loop.faults();
  ticks_before_ = loop.telemetry().counters.ticks;
  torque_before_Nm_ = loop.telemetry().verdict.torque_Nm;
  parameters_before_ = crc_of(loop.parameters());
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    for (const hal::CanFrame& frame : buses_[b]->arriving) hear(frame, b);
  }
}

void LoopWatch::hear(const hal::CanFrame& frame, std::size_t bus) {
  ++frames_;
  if (frame.id == spec(protocol::Message::kEmergencyStop).id && !frame.extended && !frame.error) {
    heard_.emergency_stop = true;
    return;
  }
  for (const Drive drive : protocol::kDrives) {
    if ((protocol::reply_spec(drive).buses >> bus & 1u) == 0) continue;
    if (decode_reply(drive, frame, measured_[index(drive)]) != DecodeResult::kOk) continue;
    replied_ns_[index(drive)] = now_ns_;
  }
  if (bus != 0) return;
  protocol::Sync sync;
  if (decode(frame, sync) == DecodeResult::kOk) heard_.sync = true;
  hear_order(frame);
}

void LoopWatch::hear_order(const hal::CanFrame& frame) {
  protocol::SupervisorOrder order;
  if (decode(frame, order) != DecodeResult::kOk || order.supervisor_id == 0) return;
  if (order.order == protocol::Order::kReset) heard_.reset = true;
  if (order.order == protocol::Order::kReady || order.order == protocol::Order::kRun) {
    heard_.start = true;
  }
}

void LoopWatch::after(const ControlLoop& loop) {
  check_modes(loop);
  check_freshness(loop);
  check_sent(loop);
  if (loop.telemetry().counters.ticks != ticks_before_) check_telemetry(loop);
}

void LoopWatch::before(const hal::SoftBoard& board, const hal::RamFlash& flash) {
  if (board.pressed) heard_.emergency_stop = heard_.emergency_stop || !emergency_;
  erases_before_ = flash.erases();
  feeds_before_ = board.feeds;
}

void LoopWatch::after(const hal::SoftBoard& board, const hal::RamFlash& flash,
                      const ControlLoop& loop) {
  const bool was_off = mode_before_ == Mode::kOff || heard_.reset;
  require(was_off || flash.erases() == erases_before_, "flash is erased in mode off only");
  require(was_off || crc_of(loop.parameters()) == parameters_before_,
          "parameters change in mode off only");
  for (const app::ParameterEntry& entry : app::parameter_table()) {
    app::Parameters copy = loop.parameters();
    const float value = entry.value(copy);
    require(value >= entry.minimum && value <= entry.maximum, "parameters keep their ranges");
  }
  require(!board.pressed || loop.mode() == Mode::kEmergencyOff,
          "nothing leaves an emergency stop while the button is pressed");
  require(board.feeds == feeds_before_ + 1, "a finished poll feeds the watchdog once");
}

void LoopWatch::check_modes(const ControlLoop& loop) {
  const Mode mode = loop.mode();
  if (heard_.emergency_stop) emergency_ = true;
  // A reset in the very poll of the stop was given before anyone could know of it.
  const bool reset = heard_.reset && !heard_.emergency_stop;
  if (reset) emergency_ = emergency_ && mode == Mode::kEmergencyOff;
  if (emergency_) {
    require(mode == Mode::kEmergencyOff, "an emergency stop holds until a reset order");
    require((loop.faults() & fault::kEmergencyStop) != 0, "an emergency stop is reported");
  }
  if (!heard_.reset) {
    require((faults_before_ & ~loop.faults()) == 0, "faults stay until a reset order");
    require(!is_latched(mode_before_) || is_latched(mode), "a latched mode stays until a reset");
  }
  require(is_moving(mode_before_) || !is_moving(mode) || heard_.start,
          "only an order starts motion");
  require(loop.faults() == 0 || !is_moving(mode), "no motion goes on with a fault");
  require((loop.faults() & fault::kInvalidWish) == 0, "the controller wishes numbers only");
}

void LoopWatch::check_freshness(const ControlLoop& loop) {
  const bool ticked = loop.telemetry().counters.ticks != ticks_before_;
  if (heard_.sync) synced_ns_ = now_ns_;
  if (!is_moving(loop.mode())) {
    moving_ticked_ = false;
    return;
  }
  if (ticked && !moving_ticked_) {
    moving_ticked_ = true;
    moving_since_ns_ = now_ns_;
  }
  if (!moving_ticked_) return;  // ordered, but no SYNC has come yet: nothing is sent
  require(now_ns_ - std::max(synced_ns_, moving_since_ns_) <= safety::kFreshness_ns,
          "no motion goes on without SYNC");
  if (!ticked) return;
  for (std::size_t i = 0; i < control::kJointCount; ++i) {
    if (!presence_.has(i)) continue;
    require(now_ns_ - std::max(replied_ns_[i], moving_since_ns_) <= safety::kFreshness_ns,
            "no motion goes on without a drive's replies");
  }
}

void LoopWatch::check_sent(const ControlLoop& loop) {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    std::array<bool, protocol::kDriveCount> exited{};
    for (const hal::CanFrame& frame : buses_[b]->sent) {
      const protocol::MessageSpec* message = find_sent(frame, b);
      require(message != nullptr, "the foot sends its own messages only, on their bus");
      require(check(*message, frame) == DecodeResult::kOk, "a sent frame is well formed");
      for (const Drive drive : protocol::kDrives) {
        if (message != &protocol::command_spec(drive)) continue;
        check_drive_frame(index(drive), frame, loop.mode());
        exited[index(drive)] = true;
      }
    }
    const bool open = !buses_[b]->bus_off && buses_[b]->room == FuzzBus::kEndless;
    if (!heard_.emergency_stop || !open) continue;
    for (std::size_t i = 0; i < control::kJointCount; ++i) {
      const bool here = (protocol::command_spec(protocol::kDrives[i]).buses >> b & 1u) != 0;
      require(!here || !presence_.has(i) || exited[i],
              "an emergency stop frees each drive at once");
    }
  }
}

void LoopWatch::check_drive_frame(std::size_t joint, const hal::CanFrame& frame, Mode mode) {
  require(presence_.has(joint), "a joint that is not there gets no frame");
  protocol::DriveOrder order;
  require(decode_command(protocol::kDrives[joint], frame, order) == DecodeResult::kOk,
          "a drive can read its command");
  require(order.action != protocol::DriveSwitch::kSetZero, "the foot never moves a drive's zero");
  if (order.action == protocol::DriveSwitch::kExit) return;
  if (order.action == protocol::DriveSwitch::kEnter) {
    require(mode == Mode::kHoming, "a drive is entered in homing only");
    return;
  }
  require(is_moving(mode) || mode == Mode::kDampedStop, "no command while the mode does not drive");
  check_command(joint, order.command, mode);
}

void LoopWatch::check_command(std::size_t joint, const protocol::DriveCommand& c, Mode mode) {
  const protocol::DriveReply& m = measured_[joint];
  const float torque_Nm = c.kp_Nm_rad * (c.position_rad - m.position_rad) +
                          c.kd_Nm_s_rad * (c.velocity_rad_s - m.velocity_rad_s) + c.torque_Nm;
  const float slack_Nm = packing_error_Nm(protocol::kDrives[joint], c, m) + kRounding_Nm;
  require(std::abs(torque_Nm) <= safety::kLimits[joint].torque_Nm + slack_Nm,
          "a drive makes no more torque than the ceiling");
  const bool seeks_zero = mode == Mode::kHoming && joint == index(control::Joint::kToe);
  require(!seeks_zero || c.kp_Nm_rad == 0.0f, "a toe without zero gets no stiffness");
  if (mode != Mode::kDampedStop) return;
  require(c.kp_Nm_rad == 0.0f, "a damped stop has no stiffness");
  require(std::copysign(1.0f, m.velocity_rad_s) * torque_Nm <= slack_Nm,
          "a damped stop only takes energy out");
}

void LoopWatch::check_telemetry(const ControlLoop& loop) {
  const app::Telemetry& t = loop.telemetry();
  require(t.counters.ticks == ticks_before_ + 1, "one tick per poll at most");
  require(heard_.sync || mode_before_ == Mode::kDampedStop || t.mode == Mode::kDampedStop ||
              t.mode == Mode::kFault,
          "only SYNC runs a tick, but for a stop under way");
  require(t.counters.frames + t.counters.bad_frames() == frames_, "every frame is counted once");
  for (std::size_t i = 0; i < control::kJointCount; ++i) check_rate(i, t);
  const float numbers[] = {t.toe_target_rad,
                           t.toe_set_point_rad,
                           t.leg_set_point_rad.hip_rad,
                           t.leg_set_point_rad.knee_rad,
                           t.foot_m.x,
                           t.foot_m.z,
                           t.foot_set_point_m.x,
                           t.foot_set_point_m.z,
                           t.foot_pitch_rad,
                           t.phase_cycles,
                           t.gait_rate_Hz,
                           t.ground.sinkage_m,
                           t.ground.force_N.x,
                           t.ground.force_N.z};
  for (const float number : numbers) require(std::isfinite(number), "telemetry is finite");
}

void LoopWatch::check_rate(std::size_t joint, const app::Telemetry& t) {
  const control::JointWish& passed = t.verdict.joint[joint];
  if (passed.action != control::DriveAction::kCommand) return;
  const safety::JointLimits& limits = safety::kLimits[joint];
  require(safety::is_finite(passed.command), "a command is made of numbers");
  const float torque_Nm = predicted_torque_Nm(passed.command, t.state[joint]);
  require(std::abs(torque_Nm) <= limits.torque_Nm + kRounding_Nm, "the gate keeps the ceiling");
  require(std::abs(passed.command.kp_Nm_rad) <= limits.kp_Nm_rad &&
              std::abs(passed.command.kd_Nm_s_rad) <= limits.kd_Nm_s_rad,
          "the gate keeps the gains");
  // Damping may set in at any rate, wished or put in the place of a wish.
  const bool damping = safety::is_pure_damping(t.wish.joint[joint].command) ||
                       (t.verdict.limits[joint] & safety::limit::kLatched) != 0;
  const float change_Nm = limits.torque_rate_Nm_s * control::kTick_s;
  require(damping || std::abs(torque_Nm - torque_before_Nm_[joint]) <= change_Nm + kRounding_Nm,
          "the gate keeps the rate");
}

}  // namespace hoof::tests::fuzz
