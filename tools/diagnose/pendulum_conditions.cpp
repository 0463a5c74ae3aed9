// Where in its operating range a pendulum is at each sample, by measured channels.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/pendulum_model.h"

namespace hoof::tools {
namespace {

using Condition = RigModel::Condition;

/// Share of the largest absolute value, of those that are not outliers.
double high(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return 0;
  for (double& v : values) v = std::abs(v);
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(0.98 * static_cast<double>(values.size() - 1))];
}

/// One significant digit, so that a reader can remember it.
double rounded(double value) {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10.0, std::floor(std::log10(value)));
  return std::round(value / scale) * scale;
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

template <typename Test>
Condition condition(const std::string& name, const std::vector<double>& values, Test test) {
  Condition c{name, {}};
  for (const double v : values) c.holds.push_back(std::isfinite(v) && test(v));
  return c;
}

/// Both ends of a channel's range, and both signs.
void add_ranges(const std::string& name, const std::vector<double>& values,
                std::vector<Condition>& list) {
  const double top = high(values);
  if (!(top > 0)) return;
  const double low = rounded(0.15 * top), much = rounded(0.5 * top);
  const auto below = [low](double v) { return std::abs(v) < low; };
  const auto above = [much](double v) { return std::abs(v) > much; };
  list.push_back(condition("|" + name + "| < " + text(low), values, below));
  list.push_back(condition("|" + name + "| > " + text(much), values, above));
  list.push_back(condition(name + " > 0", values, [](double v) { return v > 0; }));
  list.push_back(condition(name + " < 0", values, [](double v) { return v < 0; }));
}

}  // namespace

std::vector<Condition> PendulumModel::conditions(int index) const {
  const Recording& recording = *runs_[index].recording;
  const auto& position = recording.channels.at("position");
  std::vector<Condition> list;
  list.push_back({"always", std::vector<bool>(position.size(), true)});
  std::vector<double> velocity;
  if (recording.has("velocity")) {
    velocity = recording.channels.at("velocity");
  } else {
    velocity = slopes(recording.time_s, position, 0.03);
  }
  add_ranges("velocity", velocity, list);
  add_ranges("position", position, list);
  for (const char* name : {"torque", "current"}) {
    if (recording.has(name)) add_ranges(name, recording.channels.at(name), list);
  }
  return list;
}

}  // namespace hoof::tools
