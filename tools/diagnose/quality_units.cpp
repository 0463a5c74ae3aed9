// Units and signs against the setup and the other channels.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/quality_checks.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
/// A link in gravity that is told where to go does not go round more often than this.
constexpr double kMostTurns = 2.5;
constexpr double kClearCorrelation = 0.8;

const Series* find(const QualityCase& c, const std::string& channel) {
  const auto found = c.recording.channels.find(channel);
  return found == c.recording.channels.end() ? nullptr : &found->second;
}

/// True where `ratio` is `factor` within `tolerance` as a factor.
bool near_factor(double ratio, double factor, double tolerance) {
  return ratio > factor / tolerance && ratio < factor * tolerance;
}

/// A second of moving average, so that what swings beyond its resonance is not taken for a
/// wrong sign.
Series slow_part(const Series& time_s, const Series& x) {
  constexpr double kHalf_s = 0.5;
  Series slow(x.size());
  std::size_t first = 0, last = 0;
  double sum = 0;
  int count = 0;
  const auto add = [&](double value, int sign) {
    if (std::isnan(value)) return;
    sum += sign * value;
    count += sign;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    while (last < x.size() && time_s[last] <= time_s[i] + kHalf_s) add(x[last++], 1);
    while (time_s[first] < time_s[i] - kHalf_s) add(x[first++], -1);
    slow[i] = count > 0 ? sum / count : std::nan("");
  }
  return slow;
}

void check_goal(const QualityCase& c, const Series& position, const Series& goal) {
  constexpr double kTolerance = 1.5, kSlowShare = 0.3;
  if (!c.moves("position") || range_of(goal) == 0) return;
  if (position == goal) {
    return c.say("goal copied", "position", 1, true,
                 "is the same as position_goal in every sample: one column for both?");
  }
  const double ratio = deviation(position) / deviation(goal);
  const Relation relation = relate(position, goal);
  if (relation.r > 0.5 && near_factor(ratio, kDegrees, kTolerance)) {
    c.say("degrees", "position", ratio, true,
          "moves " + quality_number(ratio) +
              " times as far as its goal: suspected: degrees where rad is meant");
  }
  if (relation.r > 0.5 && near_factor(ratio, 1 / kDegrees, kTolerance)) {
    c.say("degrees", "position_goal", 1 / ratio, true,
          "moves " + quality_number(1 / ratio) +
              " times as far as position: suspected: degrees where rad is meant");
  }
  const Series slow_goal = slow_part(c.recording.time_s, goal);
  const Relation slow = relate(slow_part(c.recording.time_s, position), slow_goal);
  if (slow.r < -kClearCorrelation && deviation(slow_goal) > kSlowShare * deviation(goal)) {
    c.say("goal sign", "position", -slow.r, true,
          "goes against its goal: suspected: the sign of one of them is wrong");
  }
}

/// What the drive's law makes of the recorded position, at the joint, by the stated setup.
Series law_torque(const QualityCase& c, const Series& velocity) {
  const Setup& setup = c.recording.setup;
  const Series& position = *find(c, "position");
  const Series& goal = *find(c, "position_goal");
  const Series* velocity_goal = find(c, "velocity_goal");
  const Series* ff = find(c, "torque_ff");
  const Series* supply = find(c, "supply_voltage");
  const Series* enable = find(c, "enable");
  Series torque(position.size());
  for (std::size_t i = 0; i < torque.size(); ++i) {
    const double error = goal[i] - position[i];
    if (setup.law == DriveLaw::kImpedance) {
      const double wanted = velocity_goal != nullptr ? (*velocity_goal)[i] : 0;
      const double limit = setup.value_or("torque_limit", INFINITY);
      torque[i] = setup.value_or("kp", 0) * error +
                  setup.value_or("kd", 0) * (wanted - velocity[i]) + (ff != nullptr ? (*ff)[i] : 0);
      if (!std::isnan(torque[i])) torque[i] = std::clamp(torque[i], -limit, limit);
    } else {
      const double kt = setup.value_or("kt", 1), ohm = setup.value_or("resistance", 1);
      const double counts =
          setup.value_or("kp_duty", 0) * setup.value_or("counts_per_rad", 0) * error;
      const double duty = std::isnan(counts) ? counts : std::clamp(counts / 256 / 885, -1.0, 1.0);
      const double volts = supply != nullptr ? (*supply)[i] : setup.value_or("supply_voltage", 0);
      torque[i] = kt / ohm * (duty * volts - kt * velocity[i]);
    }
    if (enable != nullptr && (*enable)[i] == 0) torque[i] = std::nan("");
  }
  return torque;
}

/// Torque or current against the law of the drive: sign and thousands.
void check_effort(const QualityCase& c, const std::string& channel) {
  constexpr double kTolerance = 3, kLeastRelation = 0.6;
  const Series* effort = find(c, channel);
  const DriveLaw law = c.recording.setup.law;
  if (effort == nullptr || find(c, "position_goal") == nullptr) return;
  if (law != DriveLaw::kImpedance && law != DriveLaw::kDuty) return;
  const Series velocity = find(c, "velocity") != nullptr
                              ? *find(c, "velocity")
                              : derivative(c.recording.time_s, *find(c, "position"), 0.02);
  Series expected = law_torque(c, velocity);
  if (channel == "current") {
    const double kt = c.recording.setup.value_or("kt", 1);
    for (double& value : expected) value /= kt;
  }
  const Relation relation = relate(*effort, expected);
  if (relation.r < -kClearCorrelation) {
    c.say("effort sign", channel, -relation.r, true,
          "has the opposite sign of what the drive's law makes of the recorded position");
  }
  if (std::abs(relation.r) > kLeastRelation &&
      near_factor(std::abs(relation.ratio), 1000, kTolerance)) {
    c.say("effort unit", channel, relation.ratio, true,
          "is " + quality_number(std::abs(relation.ratio)) +
              " times what the drive's law asks for: suspected: thousandths (" +
              (channel == "current" ? "mA" : "mNm") + ") where " + c.unit(channel) + " is meant");
  }
}

void check_supply(const QualityCase& c) {
  constexpr double kTolerance = 3;
  const Series* supply = find(c, "supply_voltage");
  const double stated = c.recording.setup.value_or("supply_voltage", 0);
  if (supply == nullptr) return;
  const double usual = median(*supply);
  if (usual <= 0) {
    c.say("supply", "supply_voltage", 1, true, "is not above zero for most of the time");
  } else if (stated > 0 && near_factor(usual / stated, 1000, kTolerance)) {
    c.say("supply", "supply_voltage", usual, true,
          "is " + quality_number(usual) + ", the setup says " + quality_number(stated, "V") +
              ": suspected: mV where V is meant");
  }
}

void check_servo(const QualityCase& c) {
  const Series& position = *find(c, "position");
  const double far = std::max(std::abs(quantile(position, 0)), std::abs(quantile(position, 1)));
  if (far > kMostTurns * 2 * std::numbers::pi) {
    c.say("degrees", "position", far, true,
          "reaches " + quality_number(far, "rad") +
              ", more than two turns: suspected: degrees where rad is meant");
  }
  if (const Series* goal = find(c, "position_goal")) check_goal(c, position, *goal);
  for (const char* channel : {"torque", "current"}) check_effort(c, channel);
  check_supply(c);
}

/// Smaller dimension of the plate as a length, 0 where it is not stated.
double plate_size_m(const Setup& setup) {
  if (setup.find("diameter") != nullptr) return setup.value_or("diameter", 0);
  return std::min(setup.value_or("width", 0), setup.value_or("length", 0));
}

/// Nominal force at a depth, by the stated values.
double nominal_force_N(const Setup& setup, double depth_m) {
  const bool disc = setup.find("diameter") != nullptr;
  const double size_m = plate_size_m(setup), radius_m = size_m / 2;
  const double area_m2 = disc ? std::numbers::pi * radius_m * radius_m
                              : setup.value_or("width", 0) * setup.value_or("length", 0);
  const double b_m = disc ? radius_m : size_m;
  return area_m2 * (setup.value_or("k_c", 0) / b_m + setup.value_or("k_phi", 0)) *
         std::pow(depth_m, setup.value_or("n", 1));
}

void check_press(const QualityCase& c) {
  constexpr double kMostPlates = 20, kTolerance = 5;
  const Series& position = *find(c, "position");
  const Series& force = *find(c, "force");
  const Setup& setup = c.recording.setup;
  const double size_m = plate_size_m(setup), travel_m = range_of(position);
  if (size_m > 0 && travel_m > kMostPlates * size_m) {
    return c.say("millimetres", "position", travel_m, true,
                 "spans " + quality_number(travel_m, "m") + ", the plate is " +
                     quality_number(size_m, "m") + ": suspected: mm where m is meant");
  }
  if (valid_of(force).size() < 3) return;
  // Force where the press is deepest.
  Series deep;
  const double low = quantile(position, 0.1);
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (position[i] <= low && !std::isnan(force[i])) deep.push_back(force[i]);
  }
  const double deep_N = median(deep);
  if (c.moves("force") && deep_N < 0 && -deep_N > 0.5 * range_of(force)) {
    c.say("force sign", "force", -deep_N, true,
          "is " + quality_number(deep_N, "N") +
              " where the plate is deepest: it must be positive in compression");
  }
  if (c.set.rig != RigKind::kPlateSand) return;
  const double depth_m = setup.value_or("surface_height", 0) - low;
  if (depth_m <= 0) {
    return c.say("no contact", "position", 1, true,
                 "hardly gets below surface_height: no press to learn from");
  }
  const double expected_N = nominal_force_N(setup, depth_m);
  const double ratio = std::abs(deep_N) / expected_N;
  for (const double factor : {1e3, 1e-3}) {
    if (!(expected_N > 0) || !near_factor(ratio, factor, kTolerance)) continue;
    c.say("force unit", "force", ratio, true,
          "is " + quality_number(ratio) + " times what the stated soil gives: suspected: " +
              (factor > 1 ? "mN where N is meant" : "kN where N is meant"));
  }
}

}  // namespace

void check_units(const QualityCase& c) {
  if (c.set.rig == RigKind::kServoPendulum) {
    check_servo(c);
  } else {
    check_press(c);
  }
}

}  // namespace hoof::tools
