// The settings of one run: the TOML files it names and the --set overrides, merged into one tree.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace hoof::sim {

/// Where a value was written. Line 0: not in a file (a --set override).
struct Origin {
  std::string file;
  int line = 0;
  int column = 0;

  /// "feet/bionic.toml:7:12", or "--set" for an override.
  std::string text() const;
};

using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>,
                           std::vector<std::string>>;

struct Entry {
  Value value;
  Origin origin;
};

/// The value as TOML writes it: shortest decimal that reads back as the same double.
std::string to_text(const Value& value);

/// Folder of the shipped settings (sim/config of the source tree the program was built from).
std::filesystem::path default_config_dir();

/// A flat map from dotted key ("foot.middle.width_mm") to value and origin. An inline table
/// {value = 1, sigma = 2} becomes two keys; element i of an array of tables becomes "key.i.".
/// All failures throw ConfigError.
class Settings {
 public:
  using Entries = std::map<std::string, Entry, std::less<>>;

  /// An experiment with everything it refers to. `name_or_file` is a name in
  /// config_dir/experiments ("sinkage") or the path of a TOML file. Each key of its [use] table,
  /// e.g. foot = "bionic", reads config_dir/feet/bionic.toml (or the path given) under "foot";
  /// keys of the experiment file win over those files, overrides "dotted.key=value" win over all.
  static Settings load_experiment(const std::string& name_or_file,
                                  std::span<const std::string> overrides = {},
                                  const std::filesystem::path& config_dir = default_config_dir());

  /// One TOML file as it stands; a [use] table is kept as plain keys.
  static Settings load_file(const std::filesystem::path& file);

  /// TOML text; `name` stands for the file in messages.
  static Settings parse(std::string_view toml, const std::string& name);

  /// Takes over all entries of `other` below `section` ("" for the root); they win over mine.
  void merge(const Settings& other, std::string_view section = "");

  void erase(std::string_view key);

  /// Applies "dotted.key=value". The value is read as TOML, or as a string where it is none. For a
  /// measured value {value, sigma, source} the bare key sets its value.
  void set(std::string_view assignment);

  /// Null where there is no such key.
  const Entry* find(std::string_view key) const;
  const Entries& entries() const { return entries_; }

  /// Fully resolved TOML in a fixed order, each key with its origin as a comment; loading it gives
  /// the same values. [use] is left out, as everything it named is in the text.
  /// @param config_dir taken off the file names, so that the text is the same on every machine
  std::string to_toml(const std::filesystem::path& config_dir = default_config_dir()) const;

 private:
  void put(std::string key, Entry entry);
  bool has_section(const std::string& key) const;

  Entries entries_;
};

}  // namespace hoof::sim
