// A whole test: the supervisor's orders, tick after tick, and what is recorded of each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hil_bridge/fault_timeline.h"
#include "hil_bridge/lock_step.h"
#include "hil_bridge/reaction.h"

namespace hoof::bridge {

struct SessionSettings {
  bool has_toes = true;
  double toe_rad = 0;         // commanded opening per side
  bool firmware_leg = false;  // hip and knee under firmware control: a gait is ordered
  double frequency_Hz = 0;
  double toe_tolerance_rad = 0.00873;  // 0.5 degrees: the toes count as open
  double prepare_limit_s = 8;          // longest homing and opening, simulated
  int closing_ticks = 20;              // after the order to stop at the end
  int silent_ticks = 40;               // that the plant goes on without an answer of the firmware
  /// Faults to be put in, or null. With faults the session does not throw at what the firmware
  /// reports: it ends there, lets the foot come to rest, and tries a reset.
  FaultTimeline* faults = nullptr;
  double rest_limit_s = 10;    // longest wait for the foot to come to rest, and for the faults' end
  double reset_limit_s = 0.5;  // longest wait for a reset to work
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
  // With faults only.
  std::vector<FaultOutcome> faults;
  std::optional<Reaction> reaction;
  std::string ended_by;  // what the firmware reported, in words; empty: the test came to its end
};

/// Called after every tick; returns false to stop.
using TickObserver = std::function<bool(const TickRecord&)>;

/// Runs the experiment to its end: home, open the toes, go on, stop.
/// @throws std::runtime_error when the firmware refuses or faults, the foot does not become ready
/// in time, or the plant diverges: what, when and the mode; and, with faults, when one of them
/// never began or changed nothing
SessionResult run_session(sim::Experiment& experiment, const firmware::app::Parameters& parameters,
                          Wires& wires, const SessionSettings& settings,
                          const TickObserver& observer);

/// The same with a firmware that may be elsewhere, and at the pace of `pace` where it is not null.
/// When the firmware answers no more the plant goes on without it until its drives have taken their
/// torque off by themselves; then std::runtime_error names who was silent, and when they did.
SessionResult run_session(sim::Experiment& experiment, const FirmwareMaker& firmware, Wires& wires,
                          const SessionSettings& settings, const TickObserver& observer,
                          Pace* pace = nullptr);

}  // namespace hoof::bridge
