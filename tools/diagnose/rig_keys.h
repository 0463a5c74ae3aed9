// What a data set may and must say about each rig: section 3 of the contract as tables.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/toml_view.h"

namespace hoof::tools {

struct SetupKey {
  std::string name;
  Allowed allowed = Allowed::kNotNegative;
};

struct RigKeys {
  RigKind rig = RigKind::kServoPendulum;
  std::string name;
  std::vector<std::string> channels;  // "time" first; none for recordings of the project's own
  std::vector<SetupKey> setup;        // numbers; the drive's law is apart
  bool has_law = false;
};

const std::vector<RigKeys>& all_rig_keys();
const RigKeys& rig_keys(RigKind rig);

/// Names of all setup keys, "law" included.
std::vector<std::string> setup_key_names(const RigKeys& rig);

/// "duty", "impedance", "torque".
const std::vector<std::string>& law_names();
std::string law_name(DriveLaw law);
DriveLaw law_of(const std::string& name);

/// A setup key or channel that is missing, with the reason it is needed; empty: none is.
struct Lack {
  std::string name;
  std::string why;
};
/// @param setup of one recording, overrides included
Lack find_missing_setup(RigKind rig, const Setup& setup, const std::vector<std::string>& channels);
Lack find_missing_channel(RigKind rig, DriveLaw law, const std::vector<std::string>& channels);

}  // namespace hoof::tools
