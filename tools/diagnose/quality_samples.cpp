// Channels one by one: missing samples, dead and frozen ones, ends of range, steps, noise.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kLeastMissingShare = 0.01, kSeriousMissingShare = 0.2;
constexpr double kCoarse = 50;         // fewer steps than that in the whole range
constexpr double kNoiseMisstated = 3;  // a factor, either way
constexpr std::size_t kLeastSamples = 20;

/// What a sensor says, as opposed to what it was told.
const std::vector<std::string> kMeasured = {"position", "velocity", "current", "torque", "force"};

/// A run of the same value.
struct Run {
  std::size_t first = 0, last = 0;  // both included
  std::size_t length() const { return last - first + 1; }
};

std::vector<Run> runs_of(const Series& x) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i > 0 && x[i] == x[i - 1]) {
      runs.back().last = i;
    } else {
      runs.push_back({i, i});
    }
  }
  return runs;
}

void check_missing(const QualityCase& c, const std::string& channel, const Series& x) {
  const double share = 1 - double(valid_of(x).size()) / double(x.size());
  if (share == 1) {
    c.say("missing", channel, share, true, "no sample at all");
  } else if (share >= kLeastMissingShare) {
    c.say("missing", channel, share, share > kSeriousMissingShare,
          quality_number(100 * share) + " % of the samples are missing");
  }
  if (channel == "position" && std::isnan(x.front()) && share < 1) {
    c.say("no start", channel, 1, true,
          "the first sample is missing: a simulation has nowhere to start from");
  }
}

bool others_move(const QualityCase& c, const std::string& channel) {
  return std::any_of(
             kMeasured.begin(), kMeasured.end(),
             [&](const std::string& other) { return other != channel && c.moves(other); }) ||
         (channel == "position" && c.moves("position_goal"));
}

/// @return whether it is dead
bool check_dead(const QualityCase& c, const std::string& channel, const Series& x) {
  const Series valid = valid_of(x);
  if (valid.size() < kLeastSamples || range_of(valid) > 0 || !others_move(c, channel)) return false;
  c.say("dead", channel, 1, true,
        "never changes from " + quality_number(valid.front(), c.unit(channel)) +
            " though other channels do: dead?");
  return true;
}

/// How far the signal was about to go beyond a run at its extreme, by its slope on the way in.
double overshoot(const Series& x, const Run& run) {
  constexpr std::size_t kSpan = 2;
  if (run.first < kSpan) return 0;
  const double slope = std::abs(x[run.first] - x[run.first - kSpan]) / double(kSpan);
  return std::isnan(slope) ? 0 : slope * double(run.length()) / 2;
}

/// The model limits commanded torque by itself; that is no fault.
bool is_known_limit(const QualityCase& c, const std::string& channel, double extreme) {
  const double limit = c.recording.setup.value_or("torque_limit", 0);
  const double kt = channel == "current" ? c.recording.setup.value_or("kt", 1) : 1;
  return (channel == "torque" || channel == "current") && limit > 0 &&
         std::abs(extreme) * kt > 0.97 * limit;
}

void check_saturated(const QualityCase& c, const std::string& channel, const Series& x) {
  constexpr std::size_t kLeastRun = 5;
  constexpr double kLeastShare = 0.01;
  // A smooth peak rounded to steps q stays at its top for as long as takes it 2 q beyond by its
  // slope on the way in.
  constexpr double kBeyondPeak = 10;
  const Series valid = valid_of(x);
  if (valid.size() < kLeastSamples) return;
  const double step = std::max(resolution(x), c.noise(channel));
  const auto [low, high] = std::minmax_element(valid.begin(), valid.end());
  const std::vector<Run> runs = runs_of(x);
  for (const double extreme : {*low, *high}) {
    // At zero there is no end of range: no contact, no drive.
    if (extreme == 0 || is_known_limit(c, channel, extreme)) continue;
    std::size_t count = 0;
    double beyond = 0;
    for (const Run& run : runs) {
      if (x[run.first] != extreme || run.length() < kLeastRun) continue;
      count += run.length();
      beyond = std::max(beyond, overshoot(x, run));
    }
    const double share = double(count) / double(valid.size());
    if (count < kLeastSamples || share < kLeastShare || beyond < kBeyondPeak * step) continue;
    const bool effort = channel == "current" || channel == "torque";
    c.say("saturated", channel, share, !effort,
          "stays at exactly " + quality_number(extreme, c.unit(channel)) + " for " +
              quality_number(100 * share) + " % of the time: " +
              (effort ? "a limit of the drive, or a sensor at the end of its range?"
                      : "a sensor at the end of its range?"));
  }
}

/// A velocity that is rounded to steps is constant on a ramp, and rightly so.
bool turns_evenly(const QualityCase& c, const std::string& channel, const Series& x,
                  const Run& run) {
  constexpr double kHalfWindow_s = 0.05, kSteps = 3, kShare = 0.2;
  if (channel != "velocity") return false;
  const auto part = [&run](const Series& s) {
    return Series(s.begin() + std::ptrdiff_t(run.first), s.begin() + std::ptrdiff_t(run.last) + 1);
  };
  const double value = x[run.first];
  Series off = derivative(part(c.recording.time_s), part(c.recording.channels.at("position")),
                          kHalfWindow_s);
  for (double& slope : off) slope = std::abs(slope - value);
  return median(off) < std::max(kSteps * resolution(x), kShare * std::abs(value));
}

/// A sensor that stops while the machine goes on.
void check_frozen(const QualityCase& c, const std::string& channel, const Series& x) {
  constexpr double kLeast_s = 0.3, kMovedShare = 0.02, kMovedNoise = 10;
  const auto found = c.recording.channels.find("position");
  if (channel == "position" || found == c.recording.channels.end()) return;
  const Series& position = found->second;
  const double moved_least =
      std::max(kMovedShare * range_of(position), kMovedNoise * c.noise("position"));
  const double largest = std::max(std::abs(quantile(x, 0)), std::abs(quantile(x, 1)));
  for (const Run& run : runs_of(x)) {
    const double value = x[run.first];
    const double lasted_s = c.recording.time_s[run.last] - c.recording.time_s[run.first];
    if (run.length() < kLeastSamples || lasted_s < kLeast_s || std::abs(value) < 0.05 * largest ||
        value == quantile(x, 0) || value == quantile(x, 1)) {
      continue;
    }
    const Series part(position.begin() + std::ptrdiff_t(run.first),
                      position.begin() + std::ptrdiff_t(run.last) + 1);
    if (range_of(part) < moved_least || turns_evenly(c, channel, x, run)) continue;
    c.say("frozen", channel, lasted_s, true,
          "is frozen at " + quality_number(value, c.unit(channel)) + " from " +
              quality_number(c.recording.time_s[run.first], "s") + " to " +
              quality_number(c.recording.time_s[run.last], "s") + " while the machine moves");
    return;
  }
}

void check_steps(const QualityCase& c, const std::string& channel, const Series& x) {
  const double quantum = resolution(x), range = range_of(x);
  if (quantum == 0 || range == 0 || range / quantum >= kCoarse) return;
  c.say("coarse", channel, quantum / range, false,
        "comes in coarse steps of " + quality_number(quantum, c.unit(channel)) + ", " +
            quality_number(std::round(range / quantum)) + " in its whole range");
}

void check_noise(const QualityCase& c, const std::string& channel, const Series& x) {
  const auto stated = c.set.noise.find(channel);
  if (stated == c.set.noise.end() || valid_of(x).size() < kLeastSamples) return;
  const double seen = estimate_noise(c.recording.time_s, x);
  const double ratio = seen / stated->second;
  if (ratio < kNoiseMisstated && ratio > 1 / kNoiseMisstated) return;
  c.say("noise", channel, std::abs(std::log(ratio)), false,
        "noise is stated as " + quality_number(stated->second, c.unit(channel)) +
            ", but from sample to sample it is " + quality_number(seen, c.unit(channel)));
}

void check_enable(const QualityCase& c) {
  const auto found = c.recording.channels.find("enable");
  if (found == c.recording.channels.end()) return;
  for (const double value : found->second) {
    if (std::isnan(value) || value == 0 || value == 1) continue;
    c.say("enable", "enable", 1, true, "holds " + quality_number(value) + "; it must be 0 or 1");
    return;
  }
}

}  // namespace

void check_samples(const QualityCase& c) {
  for (const auto& [channel, x] : c.recording.channels) check_missing(c, channel, x);
  for (const std::string& channel : kMeasured) {
    const auto found = c.recording.channels.find(channel);
    if (found == c.recording.channels.end()) continue;
    const Series& x = found->second;
    if (check_dead(c, channel, x)) continue;
    // A link may rest at exactly one place; what stops it is physics.
    if (channel != "position") check_saturated(c, channel, x);
    check_frozen(c, channel, x);
    check_steps(c, channel, x);
    check_noise(c, channel, x);
  }
  check_enable(c);
}

}  // namespace hoof::tools
