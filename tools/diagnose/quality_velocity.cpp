// Velocity against the derivative of position: units, sign, delay.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kHalfWindow_s = 0.02;
constexpr double kClearCorrelation = 0.8;
constexpr double kMostDelay_s = 0.08;

struct Slip {
  double ratio;  // velocity over derivative
  const char* text;
};

constexpr std::array<Slip, 7> kSlips = {
    {{kDegrees, "velocity is in degrees per second where rad/s is meant"},
     {1 / kDegrees, "position is in degrees where rad is meant"},
     {30 / std::numbers::pi, "velocity is in turns per minute where rad/s is meant"},
     {0.5 / std::numbers::pi, "velocity is in turns per second where rad/s is meant"},
     {1000, "velocity is in mrad/s where rad/s is meant, or time in milliseconds"},
     {6, "position is in turns/60 or velocity in other units than rad/s"},
     {0.001, "position is in mrad where rad is meant"}}};

/// What was cut off makes the rest look small.
bool is_saturated(const QualityCase& c) {
  return std::any_of(c.findings.begin(), c.findings.end(), [&c](const QualityFinding& f) {
    return f.kind == "saturated" && f.note.channel == "velocity" &&
           f.note.recording == c.recording.name;
  });
}

void check_ratio(const QualityCase& c, double ratio) {
  constexpr double kSlipTolerance = 0.15, kRatioTolerance = 0.3;
  const double size = std::abs(ratio);
  if (ratio < 0) {
    c.say("velocity sign", "velocity", 1, true,
          "has the opposite sign of the derivative of position");
  }
  if (std::abs(std::log(size)) < std::log1p(kRatioTolerance) || is_saturated(c)) return;
  const std::string measured = "is " + quality_number(size) + " times the derivative of position";
  for (const Slip& slip : kSlips) {
    if (std::abs(size / slip.ratio - 1) > kSlipTolerance) continue;
    return c.say("velocity unit", "velocity", size, true, measured + ": suspected: " + slip.text);
  }
  c.say("velocity scale", "velocity", std::abs(std::log(size)), true, measured);
}

/// Where correlation with the derivative, over shifts in whole samples, is largest.
void check_delay(const QualityCase& c, const Series& velocity, const Series& slope) {
  constexpr double kLeastDelay_s = 0.006, kLeastSteps = 1.5, kBetter = 2;
  Series steps;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    steps.push_back(c.recording.time_s[i] - c.recording.time_s[i - 1]);
  }
  const double step_s = median(steps);
  const int most = std::min(int(kMostDelay_s / step_s), int(velocity.size() / 4));
  double best = -1;
  int at = 0;
  const auto correlation = [&](int shift) { return relate_shifted(velocity, slope, shift).r; };
  for (int shift = -most; shift <= most; ++shift) {
    if (const double r = correlation(shift); r > best) best = r, at = shift;
  }
  if (best < kClearCorrelation || std::abs(at) == most) return;
  const double left = correlation(at - 1), right = correlation(at + 1);
  const double bend = left - 2 * best + right;
  const double fine = bend < 0 ? 0.5 * (left - right) / bend : 0;
  const double delay_s = (at + fine) * step_s;
  const double lost_now = 1 - correlation(0), lost_shifted = 1 - best;
  if (std::abs(delay_s) < std::max(kLeastDelay_s, kLeastSteps * step_s)) return;
  if (lost_now < kBetter * lost_shifted) return;
  c.say("velocity delay", "velocity", std::abs(delay_s), false,
        delay_s > 0 ? "lags the derivative of position by " + quality_number(1e3 * delay_s, "ms") +
                          ": filtered, or sent late"
                    : "is ahead of the derivative of position by " +
                          quality_number(-1e3 * delay_s, "ms") + ": position is filtered or late");
}

}  // namespace

void check_velocity(const QualityCase& c) {
  const auto position = c.recording.channels.find("position");
  const auto velocity = c.recording.channels.find("velocity");
  if (position == c.recording.channels.end() || velocity == c.recording.channels.end()) return;
  if (!c.moves("position") || range_of(velocity->second) == 0) return;
  const Series slope = derivative(c.recording.time_s, position->second, kHalfWindow_s);
  const Relation relation = relate(velocity->second, slope);
  if (std::abs(relation.r) < kClearCorrelation) {
    // A late velocity is not to be taken for one that has nothing to do with position.
    Relation best = relation;
    const int most = std::min(20, int(slope.size() / 4));
    for (int shift = -most; shift <= most; ++shift) {
      const Relation other = relate_shifted(velocity->second, slope, shift);
      if (std::abs(other.r) > std::abs(best.r)) best = other;
    }
    if (std::abs(best.r) < kClearCorrelation) return;
  }
  check_ratio(c, relation.ratio);
  if (relation.r > 0) check_delay(c, velocity->second, slope);
}

}  // namespace hoof::tools
