// A fault as it is written in the settings: [[fault]] with kind, target, when, for how long.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/board.h"
#include "hil_bridge/fault_condition.h"
#include "sim/config/settings.h"

namespace hoof::bridge {

enum class FaultKind {
  kDrop = 0,
  kDelay,
  kReorder,
  kDuplicate,
  kCorrupt,
  kFlood,
  kBusOff,
  kNodeSilent,
  kNodeRestart,
  kEncoderJump,
  kEncoderStuck,
  kEncoderDrift,
  kEncoderNoise,
  kEncoderOffset,
  kTorqueLoss,
  kStall,
  kBrownOut,
  kEstop,
  kSyncJitter,
};
inline constexpr std::array kFaultKindNames = {
    "drop",          "delay",         "reorder",       "duplicate",      "corrupt",
    "flood",         "bus_off",       "node_silent",   "node_restart",   "encoder_jump",
    "encoder_stuck", "encoder_drift", "encoder_noise", "encoder_offset", "torque_loss",
    "stall",         "brown_out",     "estop",         "sync_jitter"};

struct FaultSpec {
  FaultKind kind = FaultKind::kDrop;
  std::string target;
  sim::Origin origin;  // of its kind, for errors
  std::string key;     // "fault.0"

  // Begins at the first tick at or after a time, or behind the first tick in which something holds.
  double at_s = 0;
  std::optional<FaultCondition> when;
  std::optional<double> for_s;  // none: to the end of the run

  double probability = 1;
  double delay_s = 0;  // of delay and sync_jitter
  int count = 1;       // copies of duplicate, bits of corrupt
  double amount = 0;   // SI: angle, speed, ratio, torque, supply
  int id = 0;          // of flood
  double rate_Hz = 0;  // of flood; 0: all that the wire takes
  hal::ResetCause cause = hal::ResetCause::kPowerOn;
  std::uint64_t seed = 1;

  /// "fault.0 (drop HipReply)"
  std::string name() const;
};

/// True for button, supply and reset of the foot: those of a board, which must be in this process.
bool needs_board(const FaultSpec& fault);
/// @throws sim::ConfigError saying so
[[noreturn]] void refuse_without_board(const FaultSpec& fault);

/// "drop, delay, ..."
std::string fault_kind_names();

/// All faults of a run, in their order; empty where the settings have none.
/// @throws sim::ConfigError naming file, line, key, value and bound
std::vector<FaultSpec> read_faults(const sim::Settings& settings);

}  // namespace hoof::bridge
