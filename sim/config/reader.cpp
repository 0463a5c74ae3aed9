#include "sim/config/reader.h"

#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "sim/config/config_error.h"
#include "sim/config/suggestion.h"

namespace hoof::sim {

struct Reader::Record {
  struct Missing {
    std::string key;
    std::string expectation;
  };
  /// Full keys asked for.
  std::set<std::string, std::less<>> known;
  std::vector<Missing> missing;
};

namespace {

std::string range_text(const Unit& unit, double min, double max) {
  const std::string suffix = unit.suffix.empty() ? "" : " " + std::string(unit.suffix);
  return "from " + to_text(min) + " to " + to_text(max) + suffix;
}

std::string parent_of(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot + 1);
}

/// Null unless the value is a number.
std::optional<double> as_number(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return static_cast<double>(*integer);
  return std::nullopt;
}

/// False for NaN as well.
bool in_range(double value, double min, double max) {
  return value >= min && value <= max;
}

}  // namespace

Reader::Reader(const Settings& settings) : Reader(settings, std::make_shared<Record>(), "") {}

Reader::Reader(const Settings& settings, std::shared_ptr<Record> record, std::string prefix)
    : settings_(&settings), record_(std::move(record)), prefix_(std::move(prefix)) {}

Reader Reader::section(std::string_view name) const {
  return Reader(*settings_, record_, full(name) + ".");
}

bool Reader::has(std::string_view key) const {
  if (settings_->find(full(key)) != nullptr) return true;
  const std::string below = full(key) + ".";
  const auto next = settings_->entries().lower_bound(below);
  return next != settings_->entries().end() && next->first.starts_with(below);
}

std::vector<std::string> Reader::sections() const {
  std::set<std::string> names;
  for (const auto& [key, entry] : settings_->entries()) {
    if (!key.starts_with(prefix_)) continue;
    const std::string rest = key.substr(prefix_.size());
    if (const std::size_t dot = rest.find('.'); dot != std::string::npos) {
      names.insert(rest.substr(0, dot));
    }
  }
  return {names.begin(), names.end()};
}

const Entry* Reader::take(std::string_view key, const std::string& expectation) {
  const std::string path = full(key);
  record_->known.insert(path);
  const Entry* entry = settings_->find(path);
  if (entry == nullptr) record_->missing.push_back({path, expectation});
  return entry;
}

void Reader::number(std::string_view key, double& value_si, const Unit& unit, double min,
                    double max) {
  const std::string rule = "must be a number " + range_text(unit, min, max);
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const std::optional<double> value = as_number(entry->value);
  if (!value || !in_range(*value, min, max)) fail(key, rule);
  value_si = unit.to_si(*value);
}

void Reader::numbers(std::string_view key, std::vector<double>& values_si, const Unit& unit,
                     double min, double max) {
  const std::string rule = "must be a list of numbers " + range_text(unit, min, max);
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const auto* list = std::get_if<std::vector<double>>(&entry->value);
  if (list == nullptr) fail(key, rule);
  values_si.clear();
  for (const double value : *list) {
    if (!in_range(value, min, max)) fail(key, rule);
    values_si.push_back(unit.to_si(value));
  }
}

void Reader::measured(std::string_view key, Measured& value_si, const Unit& unit, double min,
                      double max) {
  if (settings_->find(full(key)) != nullptr) {
    record_->known.insert(full(key));
    fail(key, "must be {value = , sigma = , source = \"\"}");
  }
  Reader parts = section(key);
  parts.number("value", value_si.value, unit, min, max);
  value_si.sigma = 0.0;
  if (parts.has("sigma")) parts.number("sigma", value_si.sigma, unit, 0.0, max - min);
  // Where a range is stated it holds the value; material_card.h reads it again, a run has no use
  // for it. An absent value is told by finish().
  double bound = 0.0;
  const bool there = parts.has("value");
  const double value = value_si.value * unit.denominator / unit.numerator;  // in the key's unit
  if (parts.has("low")) parts.number("low", bound, unit, min, there ? value : max);
  if (parts.has("high")) parts.number("high", bound, unit, there ? value : min, max);
  parts.text("source", value_si.source);
}

void Reader::integer(std::string_view key, std::int64_t& value, std::int64_t min,
                     std::int64_t max) {
  const std::string rule =
      "must be a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const auto* integer = std::get_if<std::int64_t>(&entry->value);
  if (integer == nullptr || *integer < min || *integer > max) fail(key, rule);
  value = *integer;
}

void Reader::integer(std::string_view key, int& value, int min, int max) {
  std::int64_t wide = value;
  integer(key, wide, std::int64_t{min}, std::int64_t{max});
  value = static_cast<int>(wide);
}

void Reader::flag(std::string_view key, bool& value) {
  const std::string rule = "must be true or false";
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const auto* flag = std::get_if<bool>(&entry->value);
  if (flag == nullptr) fail(key, rule);
  value = *flag;
}

void Reader::text(std::string_view key, std::string& value) {
  const std::string rule = "must be a string that is not empty";
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const auto* text = std::get_if<std::string>(&entry->value);
  if (text == nullptr || text->empty()) fail(key, rule);
  value = *text;
}

void Reader::choice(std::string_view key, std::string& value,
                    std::initializer_list<std::string_view> allowed) {
  std::string rule = "must be one of:";
  for (const std::string_view each : allowed) {
    rule += (each == *allowed.begin() ? " " : ", ") + std::string(each);
  }
  const Entry* entry = take(key, rule);
  if (entry == nullptr) return;
  const auto* text = std::get_if<std::string>(&entry->value);
  for (const std::string_view each : allowed) {
    if (text != nullptr && *text == each) {
      value = *text;
      return;
    }
  }
  fail(key, rule);
}

void Reader::finish() const {
  const std::vector<std::string> known(record_->known.begin(), record_->known.end());
  for (const auto& [key, entry] : settings_->entries()) {
    if (!key.starts_with(prefix_) || record_->known.contains(key)) continue;
    // First among the keys of the same section, then anywhere.
    const std::string parent = parent_of(key);
    std::vector<std::string> siblings;
    for (const std::string& each : known) {
      if (parent_of(each) == parent) siblings.push_back(each.substr(parent.size()));
    }
    std::string meant = suggest(key.substr(parent.size()), siblings);
    if (meant.empty()) meant = suggest(key, known);
    throw ConfigError(entry.origin.text() + ": " + key + " = " + to_text(entry.value) +
                      ": unknown key" + (meant.empty() ? "" : ", did you mean " + meant + "?"));
  }
  for (const Record::Missing& missing : record_->missing) {
    if (!missing.key.starts_with(prefix_)) continue;
    throw ConfigError(origin_of_section().file + ": " + missing.key + ": missing, " +
                      missing.expectation);
  }
}

Origin Reader::origin_of_section() const {
  const auto next = settings_->entries().lower_bound(prefix_);
  if (next != settings_->entries().end() && next->first.starts_with(prefix_)) {
    return next->second.origin;
  }
  return {"settings", 0, 0};
}

void Reader::check(const std::function<void()>& validate) const {
  try {
    validate();
  } catch (const std::invalid_argument& broken) {
    const std::string section = prefix_.empty() ? "" : prefix_.substr(0, prefix_.size() - 1) + ": ";
    throw ConfigError(origin_of_section().file + ": " + section + broken.what());
  }
}

void Reader::fail(std::string_view key, const std::string& rule) const {
  const Entry* entry = settings_->find(full(key));
  if (entry == nullptr) {
    throw ConfigError(origin_of_section().file + ": " + full(key) + ": " + rule);
  }
  throw ConfigError(entry->origin.text() + ": " + full(key) + " = " + to_text(entry->value) + ": " +
                    rule);
}

}  // namespace hoof::sim
