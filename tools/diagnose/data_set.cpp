#include "tools/diagnose/data_set.h"

#include <array>

#include "tools/diagnose/channel_reader.h"
#include "tools/diagnose/rig_keys.h"
#include "tools/diagnose/setup_reader.h"
#include "tools/diagnose/toml_view.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
constexpr double kStandardGravity_m_s2 = 9.81;  // as the contract rounds it
constexpr char kSessionFile[] = "recording.json";

using Keys = std::vector<std::string>;

RigKeys read_rig(const TomlView& root) {
  Keys names;
  for (const RigKeys& rig : all_rig_keys()) names.push_back(rig.name);
  const std::string name = root.choice("rig", names);
  for (const RigKeys& rig : all_rig_keys()) {
    if (rig.name == name) return rig;
  }
  root.fail("rig", "must be " + one_of(names));
}

/// A sigma of zero says nothing, as no sigma does.
std::map<std::string, double> read_noise(const TomlView& root, const RigKeys& rig) {
  std::map<std::string, double> noise;
  if (!root.has("noise")) return noise;
  const TomlView table = root.table("noise");
  Keys channels = rig.channels;
  std::erase(channels, "time");
  table.allow_only(channels, "channel of rig " + rig.name);
  for (const std::string& channel : table.keys()) {
    const double sigma = table.number(channel, Allowed::kNotNegative);
    if (sigma > 0) noise[channel] = sigma;
  }
  return noise;
}

std::optional<TimeWindow> read_window(const TomlView& table) {
  if (!table.has("window")) return std::nullopt;
  const std::vector<double> ends = table.numbers("window", 2);
  if (ends[0] >= ends[1]) table.fail("window", "its start must be before its end");
  return TimeWindow{ends[0], ends[1]};
}

/// What holds for all recordings unless they say otherwise.
struct Defaults {
  RigKeys rig;
  Setup setup;
  ChannelSources channels;
};

void read_session(const TomlView& table, Recording& recording) {
  if (!fs::is_directory(recording.path)) table.fail("session", "no such folder");
  if (!fs::is_regular_file(recording.path / kSessionFile)) {
    table.fail("session", std::string("must be a folder that hoof wrote, with ") + kSessionFile);
  }
}

void read_data(const TomlView& table, const Defaults& defaults, Recording& recording) {
  if (!fs::is_regular_file(recording.path)) table.fail("data", "no such file");
  ChannelSources sources = defaults.channels;
  if (table.has("channels")) {
    sources = read_channel_sources(table.table("channels"), defaults.rig, sources);
  }
  Keys channels;
  for (const auto& [channel, source] : sources) channels.push_back(channel);
  const auto refuse = [&](const Lack& lack, const std::string& where) {
    if (!lack.name.empty()) {
      table.fail_here(recording.name + ": " + where + "." + lack.name + ": missing; " + lack.why);
    }
  };
  const RigKind rig = defaults.rig.rig;
  refuse(find_missing_setup(rig, recording.setup, channels), "setup");
  refuse(find_missing_channel(rig, recording.setup.law, channels), "channels");
  read_channels(sources, read_window(table), table, recording);
}

Recording read_recording(const TomlView& table, const Defaults& defaults, const fs::path& folder) {
  const bool own = defaults.rig.rig == RigKind::kFootHil;
  const std::string source = own ? "session" : "data";
  table.allow_only(own ? Keys{"session", "role", "setup"}
                       : Keys{"data", "role", "setup", "window", "channels"});
  static const std::array<std::string, 2> kRoles = {"fit", "holdout"};
  Recording recording;
  recording.name = table.text(source);
  recording.path = folder / recording.name;
  recording.holdout = table.choice("role", kRoles) == "holdout";
  recording.setup = defaults.setup;
  if (table.has("setup")) {
    recording.setup = read_setup(table.table("setup"), defaults.rig, defaults.setup);
  }
  if (own) {
    read_session(table, recording);
  } else {
    read_data(table, defaults, recording);
  }
  return recording;
}

}  // namespace

std::string rig_name(RigKind rig) {
  return rig_keys(rig).name;
}

const SetupValue* Setup::find(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() ? nullptr : &found->second;
}

double Setup::value_or(const std::string& key, double otherwise) const {
  const SetupValue* value = find(key);
  return value == nullptr ? otherwise : value->value;
}

DataSet read_data_set(const fs::path& file) {
  const toml::table parsed = parse_toml_file(file);
  const TomlView root(parsed, file.string(), "");
  root.allow_only(Keys{"format", "name", "rig", "noise", "setup", "channels", "recording"});
  root.require("format", kFormat);
  DataSet set;
  set.file = file;
  set.name = root.text("name");
  Defaults defaults;
  defaults.rig = read_rig(root);
  set.rig = defaults.rig.rig;
  set.noise = read_noise(root, defaults.rig);
  if (set.rig == RigKind::kServoPendulum) {
    defaults.setup.values["gravity"] = {kStandardGravity_m_s2, 0};
  }
  if (root.has("setup")) {
    defaults.setup = read_setup(root.table("setup"), defaults.rig, defaults.setup);
  }
  if (root.has("channels")) {
    defaults.channels = read_channel_sources(root.table("channels"), defaults.rig, {});
  }
  set.setup = defaults.setup;
  const std::vector<TomlView> recordings = root.tables("recording");
  if (recordings.empty()) root.fail("recording", "must be one [[recording]] or more");
  for (const TomlView& table : recordings) {
    set.recordings.push_back(read_recording(table, defaults, file.parent_path()));
  }
  return set;
}

}  // namespace hoof::tools
