// Binds settings to the members of plain structs: each key once, with its unit and bound.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sim/config/settings.h"
#include "sim/config/units.h"

namespace hoof::sim {

/// A number somebody measured or fitted, SI. `sigma` is one standard deviation in the same unit, 0
/// where the source states none; `source` says where the number is from.
struct Measured {
  double value = 0.0;
  double sigma = 0.0;
  std::string source;
};

/// A view of one section of the settings. All views of one tree share the record of what was asked
/// for, so that finish() finds keys nobody knows. Every key asked for must be there: the settings
/// files are the one place of default values. has() makes a key optional.
///
///   Reader foot = reader.section("foot");
///   foot.number("width_mm", geometry.width_m, kMillimetre, 5.0, 200.0);
///   foot.finish();
///
/// All failures throw ConfigError.
class Reader {
 public:
  /// @param settings must outlive the reader and its sections
  explicit Reader(const Settings& settings);

  Reader section(std::string_view name) const;

  /// True where the section holds this key or a section of this name.
  bool has(std::string_view key) const;

  /// Names of the sections directly below, in alphabetical order.
  std::vector<std::string> sections() const;

  /// Reads a number and converts it to SI. The key ends in the unit's suffix.
  /// @param min, max allowed range, both ends included, in the unit of the key
  void number(std::string_view key, double& value_si, const Unit& unit, double min, double max);
  void numbers(std::string_view key, std::vector<double>& values_si, const Unit& unit, double min,
               double max);

  /// Reads {value = , sigma = , source = ""}; sigma may be absent, the source may not.
  void measured(std::string_view key, Measured& value_si, const Unit& unit, double min, double max);

  void integer(std::string_view key, std::int64_t& value, std::int64_t min, std::int64_t max);
  void integer(std::string_view key, int& value, int min, int max);
  void flag(std::string_view key, bool& value);
  void text(std::string_view key, std::string& value);
  void choice(std::string_view key, std::string& value,
              std::initializer_list<std::string_view> allowed);

  /// Throws unless every key of this section was asked for and every key asked for was there; an
  /// unknown key gets the nearest known one as a suggestion.
  void finish() const;

  /// Runs a struct's validate(); a std::invalid_argument becomes a ConfigError with file and
  /// section in front.
  void check(const std::function<void()>& validate) const;

  /// Throws for a present key, with its file, line and value: "file:3:5: key = 4: <rule>".
  [[noreturn]] void fail(std::string_view key, const std::string& rule) const;

 private:
  struct Record;

  Reader(const Settings& settings, std::shared_ptr<Record> record, std::string prefix);
  /// The entry, or null after noting that the key is missing.
  const Entry* take(std::string_view key, const std::string& expectation);
  std::string full(std::string_view key) const { return prefix_ + std::string(key); }
  Origin origin_of_section() const;

  const Settings* settings_;
  std::shared_ptr<Record> record_;
  /// "" or a dotted path with a dot at its end.
  std::string prefix_;
};

}  // namespace hoof::sim
