// Time stamps: gaps, changes of rate, clocks that were set, milliseconds for seconds.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kGap = 5;                 // in median steps
constexpr double kSeriousGapShare = 0.05;  // of the recording's length
constexpr double kMostGapsShare = 0.05;    // of all steps
constexpr double kRateChange = 1.5;
constexpr std::size_t kLeastWindow = 20;  // samples that a rate is taken over
constexpr double kWindows = 20;
constexpr double kUneven = 2;  // a step of twice or half the median
constexpr double kUnevenShare = 0.1;
// Slower than these nobody samples such a rig: the numbers are milliseconds.
constexpr double kLongestServoStep_s = 0.3, kLongestPressStep_s = 5;

Series steps_of(const Series& time_s) {
  Series steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return steps;
}

/// True where `channel` goes on across the step after sample i as over an ordinary step, though at
/// its speed it would have got far in the time that the clock says has passed. 0: cannot tell.
enum class Crossing { kCannotTell, kGap, kJump };

Crossing crossing_of(const QualityCase& c, const std::string& channel, std::size_t i,
                     double usual_s) {
  constexpr std::size_t kSpan = 8;  // samples on each side that its speed is taken from
  constexpr double kClear = 10, kSame = 0.25;
  const auto found = c.recording.channels.find(channel);
  if (found == c.recording.channels.end()) return Crossing::kCannotTell;
  const Series& x = found->second;
  const Series& t = c.recording.time_s;
  if (i < kSpan || i + kSpan + 1 >= x.size()) return Crossing::kCannotTell;
  const double before = (x[i] - x[i - kSpan]) / (t[i] - t[i - kSpan]);
  const double after = (x[i + 1 + kSpan] - x[i + 1]) / (t[i + 1 + kSpan] - t[i + 1]);
  const double speed = (before + after) / 2;
  const double way = speed * (t[i + 1] - t[i] - usual_s);
  const double noise = std::max(c.noise(channel), 1e-9 * range_of(x));
  if (!(std::abs(way) > kClear * noise)) return Crossing::kCannotTell;
  const double moved = x[i + 1] - x[i];
  const bool goes_on = std::abs(moved - speed * usual_s) < kSame * std::abs(way) &&
                       std::abs(before - after) < kSame * (std::abs(before) + std::abs(after));
  return goes_on ? Crossing::kJump : Crossing::kGap;
}

/// The clock was set: position, and the goal where it moves, go on as if no time had passed.
bool clock_jumps(const QualityCase& c, std::size_t i, double usual_s) {
  bool any = false;
  for (const char* channel : {"position", "position_goal", "force"}) {
    const Crossing crossing = crossing_of(c, channel, i, usual_s);
    if (crossing == Crossing::kGap) return false;
    any = any || crossing == Crossing::kJump;
  }
  return any;
}

void say_jumps(const QualityCase& c, const std::vector<std::size_t>& jumps, double usual_s) {
  if (jumps.empty()) return;
  const Series& t = c.recording.time_s;
  const std::size_t first = jumps.front();
  const double by_s = t[first + 1] - t[first] - usual_s;
  c.say("clock", "time", by_s, true,
        "the clock jumps by " + quality_number(by_s, "s") + " at " + quality_number(t[first], "s") +
            (jumps.size() > 1 ? " and " + std::to_string(jumps.size() - 1) + " time(s) more" : "") +
            ": the signals go on as if no time had passed, so times behind it are wrong");
}

void check_gaps(const QualityCase& c, const Series& steps, double usual_s) {
  const Series& t = c.recording.time_s;
  std::vector<std::size_t> jumps, gaps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] > kGap * usual_s) (clock_jumps(c, i, usual_s) ? jumps : gaps).push_back(i);
  }
  // So many are no gaps: the steps are uneven.
  if (double(jumps.size() + gaps.size()) > kMostGapsShare * double(steps.size())) return;
  say_jumps(c, jumps, usual_s);
  if (gaps.empty()) return;
  double together_s = 0;
  std::size_t longest = gaps.front();
  for (const std::size_t i : gaps) {
    together_s += steps[i];
    if (steps[i] > steps[longest]) longest = i;
  }
  const bool serious = together_s > kSeriousGapShare * (t.back() - t.front());
  c.say("gap", "time", together_s, serious,
        std::to_string(gaps.size()) + " gap(s) of together " + quality_number(together_s, "s") +
            ", the longest " + quality_number(steps[longest], "s") + " at " +
            quality_number(t[longest], "s") + "; usual step " + quality_number(usual_s, "s"));
}

/// @return whether it changes
bool check_rate(const QualityCase& c, const Series& steps) {
  const auto window = std::max(kLeastWindow, std::size_t(double(steps.size()) / kWindows));
  double first_s = 0;
  for (std::size_t at = 0; at + window <= steps.size(); at += window) {
    const auto begin = steps.begin() + std::ptrdiff_t(at);
    const double step_s = median(Series(begin, begin + std::ptrdiff_t(window)));
    if (at == 0) first_s = step_s;
    const double ratio = std::max(step_s / first_s, first_s / step_s);
    if (ratio <= kRateChange) continue;
    c.say("rate", "time", ratio, false,
          "the rate changes from " + quality_number(1 / first_s, "Hz") + " to " +
              quality_number(1 / step_s, "Hz") + " at about " +
              quality_number(c.recording.time_s[at], "s"));
    return true;
  }
  return false;
}

void check_evenness(const QualityCase& c, const Series& steps, double usual_s) {
  const auto uneven = std::count_if(steps.begin(), steps.end(), [usual_s](double step_s) {
    return step_s > kUneven * usual_s || step_s < usual_s / kUneven;
  });
  const double share = double(uneven) / double(steps.size());
  if (share < kUnevenShare) return;
  c.say("uneven", "time", share, false,
        "steps of time are uneven: from " + quality_number(quantile(steps, 0.05), "s") + " to " +
            quality_number(quantile(steps, 0.95), "s") +
            " (5 to 95 %); times of arrival rather than of measurement?");
}

}  // namespace

void check_time(const QualityCase& c) {
  const Series steps = steps_of(c.recording.time_s);
  const double usual_s = median(steps);
  const double longest_s =
      c.set.rig == RigKind::kServoPendulum ? kLongestServoStep_s : kLongestPressStep_s;
  if (usual_s > longest_s) {
    c.say("time unit", "time", usual_s, true,
          "one sample every " + quality_number(usual_s, "s") +
              ": milliseconds or microseconds where seconds are meant?");
  }
  check_gaps(c, steps, usual_s);
  if (!check_rate(c, steps)) check_evenness(c, steps, usual_s);
}

}  // namespace hoof::tools
