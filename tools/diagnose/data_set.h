// A data set of the mismatch tool: recordings of one rig and what the operator knew about it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hoof::tools {

enum class RigKind { kServoPendulum, kPlateSand, kRigidPress, kFootHil };

/// "servo_pendulum" ...
std::string rig_name(RigKind rig);

/// A number of [setup], SI. sigma 0: known exactly.
struct SetupValue {
  double value = 0;
  double sigma = 0;
};

enum class DriveLaw { kNone, kDuty, kImpedance, kTorque };

struct Setup {
  std::map<std::string, SetupValue> values;
  DriveLaw law = DriveLaw::kNone;

  /// Null where the key is absent.
  const SetupValue* find(const std::string& key) const;
  double value_or(const std::string& key, double otherwise) const;
};

struct Recording {
  std::string name;            // as the data set names its file: "data", or "session"
  std::filesystem::path path;  // where that is
  bool holdout = false;
  /// An experiment that is yet to be made: inputs are what to play, other channels mean nothing.
  bool planned = false;
  Setup setup;                 // the data set's, with this recording's overrides
  std::vector<double> time_s;  // strictly increasing, within the window
  /// By rig channel ("position"), each as long as time_s, SI; NaN: missing sample. Without "time".
  std::map<std::string, std::vector<double>> channels;

  bool has(const std::string& channel) const { return channels.contains(channel); }
  /// Empty where it was not recorded.
  std::span<const double> values(const std::string& channel) const {
    const auto found = channels.find(channel);
    if (found == channels.end()) return {};
    return found->second;
  }
};

struct DataSet {
  std::filesystem::path file;
  std::string name;
  RigKind rig = RigKind::kServoPendulum;
  std::map<std::string, double> noise;  // 1-sigma by channel, where stated
  Setup setup;
  std::vector<Recording> recordings;
};

/// Reads a data set and all its recordings.
/// @throws UserError: one line naming file, line and column or key, value and what is allowed
DataSet read_data_set(const std::filesystem::path& file);

}  // namespace hoof::tools
