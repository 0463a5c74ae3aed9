#include "tools/compare/tolerance.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "tools/log/decoded_frame.h"
#include "tools/run/column_unit.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

/// What two runs of the same thing on another machine or another draw of noise may differ by, about
/// ten codes of the bus or the noise of the sand: a look at whether they do the same, not a proof.
struct UnitTolerance {
  std::string_view suffix;
  Tolerance tolerance;
};
constexpr UnitTolerance kByUnit[] = {
    {"m", {1e-4, 0.01}},       {"rad", {2e-3, 0.01}},   {"m_s", {5e-3, 0.02}},
    {"rad_s", {0.05, 0.02}},   {"N", {1.0, 0.02}},      {"Nm", {0.1, 0.02}},
    {"s", {2e-3, 0.0}},        {"Hz", {1e-3, 0.01}},    {"degC", {1.0, 0.0}},
    {"C", {1.0, 0.0}},         {"V", {0.1, 0.01}},      {"A", {0.1, 0.02}},
    {"ratio", {0.01, 0.01}},   {"kg", {1e-6, 1e-3}},    {"J", {0.01, 0.02}},
    {"W", {1.0, 0.02}},        {"cycles", {2e-3, 0.0}}, {"Nm_rad", {0.1, 1e-3}},
    {"Nm_s_rad", {0.01, 1e-3}}};

double parse_number(std::string_view text, const std::string& rule) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0)) {
    throw UserError("--tol " + rule + ": '" + std::string(text) + "' must be a number, 0 or above");
  }
  return value;
}

}  // namespace

double Tolerance::at(double baseline) const {
  return std::max(absolute, relative * std::abs(baseline));
}

Tolerance default_tolerance(const SignalSeries& series) {
  if (series.whole) return {};
  Tolerance best;
  std::size_t longest = 0;
  for (const UnitTolerance& u : kByUnit) {
    const std::string ending = "_" + std::string(u.suffix);
    if (!series.name.ends_with(ending) || ending.size() <= longest) continue;
    best = u.tolerance;
    longest = ending.size();
  }
  return best;
}

ToleranceRule parse_tolerance_rule(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UserError("--tol " + text + ": expected SIGNAL=ABSOLUTE or SIGNAL=ABSOLUTE,RELATIVE");
  }
  const std::string_view numbers = std::string_view(text).substr(equals + 1);
  const std::size_t comma = numbers.find(',');
  ToleranceRule rule{text.substr(0, equals), {}};
  rule.tolerance.absolute = parse_number(numbers.substr(0, comma), text);
  if (comma != std::string_view::npos) {
    rule.tolerance.relative = parse_number(numbers.substr(comma + 1), text);
  }
  return rule;
}

Tolerance tolerance_of(const SignalSeries& series, const std::vector<ToleranceRule>& rules) {
  Tolerance tolerance = default_tolerance(series);
  for (const ToleranceRule& rule : rules) {
    if (matches_pattern(rule.pattern, series.name)) tolerance = rule.tolerance;
  }
  return tolerance;
}

}  // namespace hoof::tools
