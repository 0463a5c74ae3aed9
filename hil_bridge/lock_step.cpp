#include "hil_bridge/lock_step.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "firmware/protocol/codec.h"

namespace hoof::bridge {
namespace {

using firmware::protocol::Drive;

/// Toe on bus 0, hip and knee on bus 1, as the dictionary has it.
int bus_of(sim::Joint joint) {
  return firmware::protocol::command_spec(Drive(int(joint))).buses == firmware::protocol::kBus0 ? 0
                                                                                                : 1;
}

std::int64_t whole_exchange_ns(double exchange_s) {
  const auto ns = std::int64_t(std::llround(exchange_s * 1e9));
  if (ns <= 0 || LockStep::kTick_ns % ns != 0 || std::abs(double(ns) - exchange_s * 1e9) > 1e-3) {
    throw std::invalid_argument("coupling.exchange_us = " + std::to_string(exchange_s * 1e6) +
                                " does not divide the control tick of 1000 us");
  }
  return ns;
}

}  // namespace

LockStep::LockStep(sim::Experiment& experiment, const firmware::app::Parameters& parameters,
                   Wires& wires)
    : LockStep(experiment, local_firmware(parameters), wires) {}

LockStep::LockStep(sim::Experiment& experiment, const FirmwareMaker& firmware, Wires& wires,
                   Pace* pace)
    : experiment_(experiment),
      wires_(wires),
      master_{&wires.attach(0, kSyncNode), &wires.attach(1, kSyncNode)},
      firmware_(firmware(wires.attach(0, kFootNode), wires.attach(1, kFootNode), clock_)),
      supervisor_(wires.attach(0, kSupervisorNode)),
      exchange_ns_(whole_exchange_ns(experiment.plant().settings().exchange_s)),
      pace_(pace) {
  drives_.reserve(sim::kJointCount);  // nodes keep references, they must not move
  for (const sim::Joint joint : {sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee}) {
    if (sim::Drive* drive = experiment.plant().drive(joint)) {
      drives_.emplace_back(wires.attach(bus_of(joint), sim::joint_name(joint)), Drive(int(joint)),
                           *drive);
    }
  }
}

void LockStep::send_sync() {
  const hal::CanFrame frame = encode(firmware::protocol::Sync{tick_});
  for (hal::CanBus* bus : master_) {
    if (bus == master_[1] && wires_.one_wire()) continue;
    if (bus->send(frame) != hal::SendResult::kQueued) {
      throw std::runtime_error("SYNC " + std::to_string(tick_) + " could not be sent");
    }
  }
}

void LockStep::poll_nodes() {
  for (DriveNode& drive : drives_) drive.poll();
  firmware_->poll(tick_);
  supervisor_.poll(clock_.now_ns());
}

/// What has arrived is answered, then plant and wires go on by one exchange interval. At a pace of
/// the wall's a tick is computed at its begin, in a fraction of its time: to look for frames once
/// is enough, and twenty looks by calls of the kernel could take longer than the tick.
void LockStep::exchange(bool first, bool last) {
  if (pace_ == nullptr || first) poll_nodes();
  experiment_.advance();
  for (int j = 0; j < sim::kJointCount; ++j) {
    const double torque = experiment_.plant().joint_torque_Nm(sim::Joint(j));
    torques_.mean_Nm[j] += torque * double(exchange_ns_) / double(kTick_ns);
    torques_.peak_Nm[j] = std::max(torques_.peak_Nm[j], std::abs(torque));
    const sim::Drive* drive = experiment_.plant().drive(sim::Joint(j));
    if (drive == nullptr) continue;
    const double motor_Nm = drive->motor_torque_Nm();
    if (std::abs(motor_Nm) >= drive->settings().torque_limit_Nm) {
      torques_.limited_s[j] += double(exchange_ns_) * 1e-9;
    }
    if (motor_Nm * drive->rotor_velocity_rad_s() >= 0) {
      torques_.push_Nm[j] = std::max(torques_.push_Nm[j], std::abs(motor_Nm));
    }
  }
  clock_.advance_to(clock_.now_ns() + exchange_ns_);
  if (pace_ == nullptr || last) wires_.advance_to(clock_.now_ns());
}

void LockStep::tick() {
  torques_ = {};
  send_sync();
  for (std::int64_t t = 0; t < due_ticks_ * kTick_ns; t += exchange_ns_) {
    exchange(t % kTick_ns == 0, (t + exchange_ns_) % kTick_ns == 0);
  }
  if (pace_ != nullptr) due_ticks_ = pace_->rest([this] { poll_nodes(); });
  tick_ += due_ticks_;
}

}  // namespace hoof::bridge
