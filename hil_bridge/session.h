// A whole test: the supervisor's orders, tick after tick, and what is recorded of each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hil_bridge/lock_step.h"

namespace hoof::bridge {

struct SessionSettings {
  bool has_toes = true;
  double toe_rad = 0;         // commanded opening per side
  bool firmware_leg = false;  // hip and knee under firmware control: a gait is ordered
  double frequency_Hz = 0;
  double toe_tolerance_rad = 0.00873;  // 0.5 degrees: the toes count as open
  double prepare_limit_s = 8;          // longest homing and opening, simulated
  int closing_ticks = 20;              // after the order to stop at the end
};

/// Everything of one control tick, for recorders.
struct TickRecord {
  sim::Observation plant;
  const firmware::app::Telemetry& firmware;
  TickTorques torques;
};

struct SessionResult {
  std::uint32_t ticks = 0;
  std::uint64_t frames = 0;
  bool interrupted = false;
  double toe_command_rad = 0;
  double toe_reached_rad = 0;     // true mean opening when the test went on
  double toe_deflection_rad = 0;  // largest |true mean opening - command| under load
  std::array<double, sim::kJointCount> torque_peak_Nm{};
  std::array<double, sim::kJointCount> torque_limited_s{};  // time at the drive's own limit
  std::uint32_t gate_interventions = 0;
  std::array<double, kBusCount> bus_load_ratio{};
  std::array<double, kBusCount> worst_bus_load_ratio{};
};

/// Called after every tick; returns false to stop.
using TickObserver = std::function<bool(const TickRecord&)>;

/// Runs the experiment to its end: home, open the toes, go on, stop.
/// @throws std::runtime_error when the firmware refuses or faults, the foot does not become ready
/// in time, or the plant diverges: what, when and the mode
SessionResult run_session(sim::Experiment& experiment, const FirmwareFactory& firmware,
                          Wires& wires, const SessionSettings& settings,
                          const TickObserver& observer);

}  // namespace hoof::bridge
