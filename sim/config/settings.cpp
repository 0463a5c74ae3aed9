#include "sim/config/settings.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "sim/config/config_error.h"
#include "sim/config/suggestion.h"
#include "sim/config/toml_entries.h"

namespace hoof::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kUsePrefix = "use.";
constexpr std::string_view kMaterials = "materials", kCardPrefix = "card.";

/// Section of a run and the folder of its presets.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPresetFolders = {{
    {"bed", "beds"},
    {"coupling", "coupling"},
    {"drives", "drives"},
    {"foot", "feet"},
    {"leg", "legs"},
    {"materials", "materials"},
    {"rft_terrain", "rft_terrain"},
    {"rigid_terrain", "rigid_terrain"},
}};

std::string read_text(const fs::path& file, const std::string& asked_by) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  // A folder opens but does not read.
  if (stream && !fs::is_directory(file)) text << stream.rdbuf();
  if (!stream || fs::is_directory(file)) {
    const char* why = fs::is_directory(file) ? "is a folder" : std::strerror(errno ? errno : EIO);
    throw ConfigError(asked_by + file.string() + ": cannot be read: " + why);
  }
  return text.str();
}

bool is_path(const std::string& name) {
  return name.find('/') != std::string::npos || name.ends_with(".toml");
}

std::vector<std::string> preset_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& item : fs::directory_iterator(folder, ignored)) {
    if (item.path().extension() == ".toml") names.push_back(item.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// @param where printed in front of errors: the origin that named the preset, or ""
fs::path find_preset(const fs::path& folder, const std::string& name, const fs::path& relative_to,
                     const std::string& where) {
  if (is_path(name)) return relative_to / name;
  const fs::path file = folder / (name + ".toml");
  if (fs::exists(file)) return file;
  const std::vector<std::string> known = preset_names(folder);
  const std::string meant = suggest(name, known);
  std::string all;
  for (const std::string& each : known) all += (all.empty() ? "" : ", ") + each;
  throw ConfigError(where + "\"" + name +
                    "\": " + (meant.empty() ? "" : "did you mean \"" + meant + "\"? ") +
                    "must be one of: " + all + ", or the path of a TOML file");
}

std::string_view preset_folder(const std::string& section, const Entry& entry) {
  std::vector<std::string> known;
  for (const auto& [name, folder] : kPresetFolders) {
    if (name == section) return folder;
    known.emplace_back(name);
  }
  const std::string meant = suggest(section, known);
  throw ConfigError(entry.origin.text() + ": use." + section + " = " + to_text(entry.value) +
                    ": unknown key" + (meant.empty() ? "" : ", did you mean use." + meant + "?"));
}

std::string trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(kBlank) - first + 1));
}

}  // namespace

fs::path default_config_dir() {
  return HOOF_CONFIG_DIR;
}

Settings Settings::parse(std::string_view toml, const std::string& name) {
  Settings settings;
  for (auto& [key, entry] : toml_entries(toml, name)) settings.put(key, std::move(entry));
  return settings;
}

Settings Settings::load_file(const fs::path& file) {
  return parse(read_text(file, ""), file.string());
}

Settings Settings::load_experiment(const std::string& name_or_file,
                                   std::span<const std::string> overrides,
                                   const fs::path& config_dir) {
  const fs::path file = find_preset(config_dir / "experiments", name_or_file, "", "experiment ");
  Settings experiment = load_file(file);
  for (const std::string& assignment : overrides) {
    if (assignment.starts_with(kUsePrefix)) experiment.set(assignment);
  }

  Settings run;
  Settings own;
  for (const auto& [key, entry] : experiment.entries_) {
    if (!key.starts_with(kUsePrefix)) {
      own.entries_.emplace(key, entry);
      continue;
    }
    const std::string section = key.substr(kUsePrefix.size());
    const std::string where = entry.origin.text() + ": " + key + " = ";
    const auto* name = std::get_if<std::string>(&entry.value);
    if (name == nullptr) throw ConfigError(where + to_text(entry.value) + ": must be a string");
    const fs::path folder = config_dir / preset_folder(section, entry);
    const fs::path relative_to = entry.origin.line > 0 ? file.parent_path() : fs::path();
    const fs::path preset = find_preset(folder, *name, relative_to, where);
    Settings part = parse(read_text(preset, where), preset.string());
    // A material's card is for its reader, and must not make another run of the same numbers.
    if (section == kMaterials) {
      std::erase_if(part.entries_, [](const auto& e) { return e.first.starts_with(kCardPrefix); });
    }
    run.merge(part, section);
  }
  run.merge(own);
  for (const std::string& assignment : overrides) {
    if (!assignment.starts_with(kUsePrefix)) run.set(assignment);
  }
  return run;
}

void Settings::merge(const Settings& other, std::string_view section) {
  const std::string prefix = section.empty() ? "" : std::string(section) + ".";
  for (const auto& [key, entry] : other.entries_) put(prefix + key, entry);
}

void Settings::erase(std::string_view key) {
  if (const auto found = entries_.find(key); found != entries_.end()) entries_.erase(found);
}

void Settings::set(std::string_view assignment) {
  const std::string whole(assignment);
  const std::size_t equals = assignment.find('=');
  const std::string key = trimmed(assignment.substr(0, equals));
  if (equals == std::string_view::npos || key.empty()) {
    throw ConfigError("--set " + whole + ": must be key=value");
  }
  if (whole.find_first_of("\r\n") != std::string::npos) {
    throw ConfigError("--set " + key + ": must be a single line");
  }
  const std::string text = trimmed(assignment.substr(equals + 1));
  std::vector<std::pair<std::string, Entry>> parsed;
  try {
    parsed = toml_entries("v = " + text, "--set");
  } catch (const ConfigError&) {
    // Not a TOML value: a bare word, taken as a string. A number with a slip is caught by its type.
    parsed = {{"v", Entry{text, {}}}};
  }
  for (auto& [below, entry] : parsed) {
    entry.origin = {"--set", 0, 0};
    put(key + below.substr(1), std::move(entry));
  }
}

const Entry* Settings::find(std::string_view key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? nullptr : &found->second;
}

bool Settings::has_section(const std::string& key) const {
  const auto next = entries_.lower_bound(key + ".");
  return next != entries_.end() && next->first.starts_with(key + ".");
}

void Settings::put(std::string key, Entry entry) {
  if (entries_.contains(key + ".value")) {
    // A bare number replaces a measured value; its source and doubt no longer hold.
    entries_[key + ".sigma"] = {0.0, entry.origin};
    entries_[key + ".source"] = {"set in " + entry.origin.text(), entry.origin};
    key += ".value";
  }
  if (has_section(key)) {
    throw ConfigError(entry.origin.text() + ": " + key + " = " + to_text(entry.value) +
                      ": is a section, must not have a value");
  }
  for (std::size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1)) {
    if (entries_.contains(key.substr(0, dot))) {
      throw ConfigError(entry.origin.text() + ": " + key + ": " + key.substr(0, dot) +
                        " is a value, must not be a section");
    }
  }
  entries_.insert_or_assign(std::move(key), std::move(entry));
}

}  // namespace hoof::sim
