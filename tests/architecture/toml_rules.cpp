#include "tests/architecture/toml_rules.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <regex>
#include <set>
#include <sstream>

namespace hoof::tests {
namespace {

/// Endings of keys that hold numbers without a unit.
constexpr std::array kPureEndings = {"_count", "_ratio", "_friction", "_share", "_factor"};

/// Keys that hold numbers without a unit.
constexpr std::array kPureKeys = {
    "bekker_exponent",      // of the pressure over depth
    "count",                // of spines, grains
    "cycles",               // of the stance ellipse
    "encoder_counts_turn",  // counts in a turn of the motor
    "friction",             // coefficient of Coulomb friction
    "middle_count_row",     // spines in a row
    "poisson",              // Poisson's ratio
    "restitution",          // speed after over speed before
    "schema_version",
    "seed",
    "threads",
};

/// Keys inside the table of a measured value: it is the table's own key that names the unit.
constexpr std::array kPartsOfValue = {"value", "sigma", "low", "high"};

template <typename List>
bool contains(const List& list, std::string_view key) {
  return std::any_of(list.begin(), list.end(),
                     [key](std::string_view item) { return item == key; });
}

std::set<std::string> unit_suffixes(const std::vector<SourceFile>& files) {
  static const std::regex kUnit("Unit k[A-Za-z]+\\{\"([A-Za-z0-9_]+)\"");
  std::set<std::string> suffixes;
  for (const SourceFile& file : files) {
    if (file.path != "sim/config/units.h") continue;
    for (const std::string& line : file.lines) {
      std::smatch match;
      if (std::regex_search(line, match, kUnit)) suffixes.insert(match[1]);
    }
  }
  return suffixes;
}

bool is_number(const toml::node& node) {
  if (node.is_number()) return true;
  const toml::array* array = node.as_array();
  return array != nullptr && !array->empty() && array->front().is_number();
}

class TomlCheck {
 public:
  TomlCheck(const SourceFile& file, const std::set<std::string>& units, std::vector<Finding>& out)
      : file_(file), units_(units), findings_(out) {}

  void check(const toml::table& table, const std::string& own_key) {
    for (const auto& [toml_key, node] : table) {
      const std::string key(toml_key.str());
      if (const toml::table* inner = node.as_table()) {
        check(*inner, key);
      } else if (is_number(node) && !names_unit(contains(kPartsOfValue, key) ? own_key : key)) {
        const int line = static_cast<int>(node.source().begin.line);
        findings_.push_back({file_.path, line, "the key " + key + " does not end in a unit"});
      }
    }
  }

 private:
  bool names_unit(const std::string& key) const {
    const auto ends_key = [&key](const std::string& ending) { return key.ends_with(ending); };
    return contains(kPureKeys, key) ||
           std::any_of(kPureEndings.begin(), kPureEndings.end(), ends_key) ||
           std::any_of(units_.begin(), units_.end(),
                       [&](const std::string& unit) { return ends_key("_" + unit); });
  }

  const SourceFile& file_;
  const std::set<std::string>& units_;
  std::vector<Finding>& findings_;
};

}  // namespace

std::vector<Finding> check_toml_units(const std::vector<SourceFile>& files) {
  const std::set<std::string> units = unit_suffixes(files);
  std::vector<Finding> findings;
  if (units.empty()) findings.push_back({"sim/config/units.h", 0, "no table of units found"});
  for (const SourceFile& file : files) {
    if (!file.path.starts_with("sim/config/") || !file.path.ends_with(".toml")) continue;
    std::ostringstream text;
    for (const std::string& line : file.lines) text << line << '\n';
    try {
      const toml::table table = toml::parse(text.str(), file.path);
      TomlCheck(file, units, findings).check(table, "");
    } catch (const toml::parse_error& error) {
      const int line = static_cast<int>(error.source().begin.line);
      findings.push_back({file.path, line, std::string(error.description())});
    }
  }
  return findings;
}

}  // namespace hoof::tests
