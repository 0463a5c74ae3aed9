// What carries the frames of a run, and who answers SYNC: the firmware in this process on simulated
// wires, or one elsewhere on a CAN interface, in lock-step or in real time.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hil_bridge/real_time.h"
#include "hil_bridge/remote_line.h"
#include "hil_bridge/session.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

inline constexpr char kInProcess[] = "in_process";

struct BusChoice {
  bool real_time = false;
  double patience_s = 5;  // by the wall: for the heartbeat at the start, and for every answer
};

/// @throws UserError where the run cannot be done that way, saying why
void check_bus_choice(const RunSettings& run, const BusChoice& choice);

class RunBus {
 public:
  /// On a CAN interface: waits for the foot's heartbeat, until `stopped` says so.
  /// @throws as check_bus_choice; std::runtime_error where nobody is there
  RunBus(const RunSettings& run, const BusChoice& choice,
         const std::function<bool()>& stopped = {});

  /// Passes the parameters and makes the wires. Once.
  bridge::Wires& start(bridge::Wires::Observer observer);
  bridge::FirmwareMaker firmware();
  /// "in_process" where the frames go over simulated wires, as those of a lock-step run do wherever
  /// its firmware is; else the interfaces.
  std::string wires_name() const { return choice_.real_time ? run_.bus : kInProcess; }
  /// Null in lock-step.
  bridge::Pace* pace() { return pace_ ? pace_.get() : nullptr; }

  /// For result.json and for people; empty in one process.
  nlohmann::ordered_json report() const;
  std::string text() const;

 private:
  bool remote() const { return run_.bus != kInProcess; }
  void require_presence() const;

  const RunSettings& run_;
  BusChoice choice_;
  std::unique_ptr<bridge::RemoteLine> line_;  // null in one process, and once real time began
  std::unique_ptr<bridge::Wires> wires_;
  std::unique_ptr<bridge::RealTimePace> pace_;
  std::vector<std::string> refused_;  // of what real time asks of the system
  std::vector<std::string> parameters_changed_;
};

}  // namespace hoof::tools
