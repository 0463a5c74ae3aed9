// The real firmware and the simulated plant on one clock: SYNC k, the firmware's answer over the
// buses, one millisecond of plant, SYNC k + 1. However slow the sand is, control notices nothing.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "firmware/app/control_loop.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "hil_bridge/drive_node.h"
#include "hil_bridge/supervisor.h"
#include "hil_bridge/wires.h"
#include "sim/experiments/experiment.h"

namespace hoof::bridge {

/// Torques at the joint and the drives' orders, as seen over one tick.
struct TickTorques {
  std::array<double, sim::kJointCount> mean_Nm{};    // gear on joint
  std::array<double, sim::kJointCount> peak_Nm{};    // largest magnitude of any exchange interval
  std::array<double, sim::kJointCount> limited_s{};  // time for which the drive's own limit clipped
};

class LockStep {
 public:
  static constexpr std::int64_t kTick_ns = 1'000'000;

  /// @throws std::invalid_argument where the plant's exchange interval does not divide a tick
  LockStep(sim::Experiment& experiment, const firmware::app::Parameters& parameters, Wires& wires);

  /// One control period. @throws std::runtime_error when the plant diverges
  void tick();

  Supervisor& supervisor() { return supervisor_; }
  const Supervisor& supervisor() const { return supervisor_; }
  const firmware::app::ControlLoop& firmware() const { return *firmware_; }
  /// The firmware ends where it is and starts anew, knowing nothing but its parameters.
  void restart_firmware(hal::ResetCause cause);
  /// The board under the firmware: button and supply.
  hal::SoftBoard& board() { return board_; }
  const TickTorques& torques() const { return torques_; }
  std::uint32_t ticks() const { return tick_; }
  std::int64_t now_ns() const { return clock_.now_ns(); }

 private:
  void send_sync();
  void poll_nodes();
  void exchange();

  sim::Experiment& experiment_;
  Wires& wires_;
  hal::SteppedClock clock_;
  hal::SoftBoard board_;
  firmware::app::Parameters parameters_;
  std::array<hal::CanBus*, kBusCount> master_{};
  firmware::app::ControlLoop::Buses foot_{};
  std::optional<firmware::app::ControlLoop> firmware_;  // always there; it can start anew
  Supervisor supervisor_;
  std::vector<DriveNode> drives_;
  std::int64_t exchange_ns_;
  std::uint32_t tick_ = 0;
  TickTorques torques_;
};

}  // namespace hoof::bridge
