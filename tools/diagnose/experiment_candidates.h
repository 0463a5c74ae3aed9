// Experiments that could be made on the machine of some recordings.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"

namespace hoof::tools {

struct Candidate {
  std::string action;
  /// What it takes beside playing another trajectory, and beside its time: in decades of odds that
  /// an experiment without it may be worse.
  double effort = 0;
  DataSet set;  // one planned recording
  /// By predicted channel: one that some hypothesis expects to be left is not made.
  struct Bounds {
    double low = 0, high = 0;
  };
  std::map<std::string, Bounds> safe = {};
};

/// The name of what is to be recorded, in the planned data sets.
inline constexpr char kRecordedFile[] = "next_experiment_recorded.csv";

/// Numbers of the setup that are as doubtful, by key: as fitted.
using FittedSetup = std::map<std::string, double>;

/// Motions within the angles and speeds of the recordings; with other payloads and gains, and on a
/// constant supply. Empty where the recordings do not move.
std::vector<Candidate> pendulum_candidates(const std::vector<DataSet>& sets,
                                           const FittedSetup& fitted);

/// Presses of plates in sand and on a block, within the force of the recordings.
std::vector<Candidate> press_candidates(const std::vector<DataSet>& sets);

/// By rig; empty where there are none, as for sessions of the foot.
std::vector<Candidate> experiment_candidates(const std::vector<DataSet>& sets,
                                             const FittedSetup& fitted);

}  // namespace hoof::tools
