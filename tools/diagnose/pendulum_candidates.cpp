// Experiments on a servo pendulum: motions within what its recordings show, and changes of payload,
// gain and supply.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/diagnose/experiment_candidates.h"
#include "tools/diagnose/goal_path.h"
#include "tools/diagnose/noise.h"
#include "tools/diagnose/pendulum_safety.h"
#include "tools/report/display_unit.h"

namespace hoof::tools {
namespace {

using std::numbers::pi;

/// Decades of odds that a change of the machine must be worth.
constexpr double kOff = 0.25, kOtherGain = 0.5, kOtherPayload = 1, kSteadySupply = 1;
constexpr double kSettle_s = 0.5;

std::string number(double value) {
  return format_significant(value, 3);
}

struct Motion {
  std::string text;
  GoalPath path;
  double effort = 0;
  bool with_changes = false;  // worth making with another payload, gain or supply
};

class Motions {
 public:
  explicit Motions(const PendulumSafety& safe) : s_(safe), half_(0.5 * safe.span_rad()) {
    // A round number: hundredths of the span are no reason.
    const double step_rad = 0.02 * half_;
    middle_ = step_rad * std::round(0.5 * (safe.low_rad + safe.high_rad) / step_rad) + 0.0;
  }

  std::vector<Motion> take() {
    staircase();
    slow_triangle();
    reversals();
    chirp();
    cycles(8, false);
    cycles(40, true);
    long_hold();
    about_hanging();
    swing();
    steps();
    return std::move(motions_);
  }

 private:
  GoalPath start() const {
    GoalPath path(std::clamp(0.0, s_.low_rad, s_.high_rad), s_.step_s);
    path.hold(kSettle_s);
    return path;
  }
  double brisk() const { return 0.5 * s_.speed_rad_s; }
  std::string range() const { return number(s_.low_rad) + " to " + number(s_.high_rad) + " rad"; }

  void staircase() {
    constexpr int kLevels = 9;
    GoalPath path = start();
    path.ease(s_.low_rad, brisk());
    for (int i = 0; i < 2 * kLevels - 1; ++i) {
      const int level = i < kLevels ? i : 2 * kLevels - 2 - i;
      path.ease(s_.low_rad + s_.span_rad() * level / (kLevels - 1), brisk()).hold(0.8);
    }
    motions_.push_back(
        {"hold 9 angles from " + range() + " for 0.8 s each, up and down", path, 0, true});
  }

  void slow_triangle() {
    GoalPath path = start();
    const double speed = std::min(s_.span_rad() / 6, s_.speed_rad_s);
    path.ease(s_.low_rad, brisk());
    for (int i = 0; i < 2; ++i) path.ramp(s_.high_rad, speed).ramp(s_.low_rad, speed);
    motions_.push_back(
        {"two slow triangles from " + range() + " and back at " + number(speed) + " rad/s", path, 0,
         true});
  }

  void reversals() {
    GoalPath path = start();
    path.ease(middle_, brisk());
    for (const double share : {0.02, 0.08, 0.3, 0.9}) {
      const double speed = share * s_.speed_rad_s;
      const double reach = std::min(0.9 * half_, 2 * speed);  // eight seconds at most
      path.ramp(middle_ + reach, speed).ramp(middle_ - reach, speed).ramp(middle_, speed);
    }
    motions_.push_back({"triangles both ways about " + number(middle_) + " rad at " +
                            number(0.02 * s_.speed_rad_s) + ", " + number(0.08 * s_.speed_rad_s) +
                            ", " + number(0.3 * s_.speed_rad_s) + " and " +
                            number(0.9 * s_.speed_rad_s) + " rad/s",
                        path, 0, true});
  }

  void chirp() {
    const double fastest_Hz = std::min(20.0, 0.1 / s_.step_s);
    if (fastest_Hz < 1) return;
    GoalPath path = start();
    path.ease(middle_, brisk());
    path.chirp(0.3 * half_, 0.3, fastest_Hz, 15, 0.5 * s_.speed_rad_s).hold(kSettle_s);
    motions_.push_back({"a chirp of the goal about " + number(middle_) + " rad from 0.3 to " +
                            number(fastest_Hz) + " Hz, no faster than " +
                            number(0.5 * s_.speed_rad_s) + " rad/s",
                        path});
  }

  /// A fast sine; or a load cycle that is repeated for long.
  void cycles(double time_s, bool slower) {
    GoalPath path = start();
    path.ease(middle_, brisk());
    const double reach = 0.9 * half_;
    const double rate_Hz = (slower ? 0.4 : 0.9) * s_.speed_rad_s / (2 * pi * reach);
    const int count = std::max(1, static_cast<int>(time_s * rate_Hz));
    path.sine(reach, rate_Hz, count).hold(kSettle_s);
    motions_.push_back(
        {"a sine of " + number(reach) + " rad about " + number(middle_) + " rad at " +
             number(rate_Hz) + " Hz, " +
             (count == 1 ? "one cycle" : std::to_string(count) + " cycles without a pause"),
         path, 0, slower});
  }

  /// Where gravity pulls most.
  void long_hold() {
    const double low = std::clamp(s_.low_rad, -0.5 * pi, 0.5 * pi);
    const double high = std::clamp(s_.high_rad, -0.5 * pi, 0.5 * pi);
    const double at = std::abs(std::sin(low)) > std::abs(std::sin(high)) ? low : high;
    GoalPath path = start();
    const double home = path.last_rad();
    path.ease(at, brisk()).hold(30).ease(home, brisk()).hold(1);
    motions_.push_back({"hold " + number(at) + " rad for 30 s", path, 0, true});
  }

  void about_hanging() {
    const double reach = std::min({0.2 * half_, s_.high_rad, -s_.low_rad});
    if (reach <= 0) return;
    GoalPath path = start();
    const double speed = std::min(reach, 0.1 * s_.speed_rad_s);
    for (int i = 0; i < 4; ++i) path.ramp(reach, speed).ramp(-reach, speed);
    path.ramp(0, speed);
    motions_.push_back({"four slow triangles of " + number(reach) +
                            " rad about the hanging position, where the load changes side",
                        path});
  }

  void swing() {
    const double from = std::min(s_.high_rad, -s_.low_rad);
    if (s_.torque_driven || from < 0.1) return;
    GoalPath path = start();
    path.ease(from, brisk()).hold(1).off(3).ease(0, brisk()).hold(0.5);
    path.ease(-from, brisk()).hold(1).off(3).ease(0, brisk()).hold(0.5);
    motions_.push_back({"let the link swing freely for 3 s with the drive off, from " +
                            number(from) + " and " + number(-from) + " rad",
                        path, kOff});
  }

  void steps() {
    if (s_.jump_rad <= 0 || s_.torque_driven) return;
    const double reach = std::min(0.4 * half_, 0.5 * s_.jump_rad);
    GoalPath path = start();
    path.ease(middle_ - reach, brisk()).hold(1);
    for (int i = 0; i < 4; ++i)
      path.jump(middle_ + reach).hold(1.2).jump(middle_ - reach).hold(1.2);
    motions_.push_back({"four steps there and back between " + number(middle_ - reach) + " and " +
                            number(middle_ + reach) + " rad",
                        path});
  }

  PendulumSafety s_;
  double middle_ = 0, half_ = 0;
  std::vector<Motion> motions_;
};

/// A change of the machine, applied to the recording that is planned.
struct Change {
  std::string text;
  double effort = 0;
  std::map<std::string, double> factors = {};  // of setup values, their doubt with them
  std::optional<double> supply_V = {};
};

std::vector<Change> changes_of(const DataSet& set, const Recording& base) {
  std::vector<Change> changes;
  const Setup& setup = base.setup;
  const double payload_kg = setup.value_or("payload_mass", 0);
  const auto payload = [&](double factor) {
    changes.push_back(
        {"payload " + number(factor * payload_kg) + " kg in place of " + number(payload_kg),
         kOtherPayload,
         {{"payload_mass", factor}}});
  };
  if (payload_kg > 0) {
    payload(2);
    payload(0.5);
    if (setup.value_or("arm_mass", 0) + setup.value_or("armature", 0) > 0) {
      changes.push_back({"without the payload", kOtherPayload, {{"payload_mass", 0}}});
    }
  }
  const std::string gain = setup.law == DriveLaw::kDuty ? "kp_duty" : "kp";
  const double stated = setup.value_or(gain, 0);
  if (setup.law == DriveLaw::kTorque || stated <= 0) return changes;
  // A softer loop is as safe; a stiffer one only where it was seen.
  std::vector<double> gains = {0.5 * stated};
  for (const Recording& r : set.recordings) gains.push_back(r.setup.value_or(gain, stated));
  std::sort(gains.begin(), gains.end());
  gains.erase(std::unique(gains.begin(), gains.end()), gains.end());
  if (gains.size() > 3) gains = {gains.front(), gains.back()};
  for (const double g : gains) {
    if (g == stated) continue;
    Change change{gain + " = " + number(g), kOtherGain, {{gain, g / stated}}};
    if (gain == "kp") {
      change.factors["kd"] = std::sqrt(g / stated);  // damped alike
      change.text += ", kd = " + number(std::sqrt(g / stated) * setup.value_or("kd", 0));
    }
    changes.push_back(std::move(change));
  }
  if (setup.law == DriveLaw::kDuty && !base.has("supply_voltage") && setup.find("supply_voltage")) {
    const double volt = setup.find("supply_voltage")->value;
    changes.push_back({"on a regulated supply of " + number(volt) + " V, the voltage recorded",
                       kSteadySupply,
                       {},
                       volt});
  }
  return changes;
}

/// What a torque must be for the link to follow, by the equation of the rig: the drive's own loop
/// is not in the recordings.
std::vector<double> torque_to_follow(const GoalPath& path, const Recording& planned,
                                     const FittedSetup& fitted) {
  const auto value = [&](const char* key) {
    const auto found = fitted.find(key);
    const bool own = planned.setup.values.contains(key);
    return found != fitted.end() && !own ? found->second : planned.setup.value_or(key, 0);
  };
  const double m = value("payload_mass"), l = value("payload_length"), arm = value("arm_mass");
  const double inertia = (m + arm / 3) * l * l + value("armature");
  const double weight = value("gravity") * l * (m + arm / 2);
  const std::vector<double> time_s = planned.time_s;
  const std::vector<double> w = slopes(time_s, path.goal_rad(), 0.05);
  const std::vector<double> a = slopes(time_s, w, 0.05);
  std::vector<double> torque;
  for (std::size_t i = 0; i < w.size(); ++i) {
    // Friction turns round gently, so that rest stays rest.
    const double direction = std::tanh(w[i] / 0.02);
    torque.push_back(inertia * a[i] + value("viscous") * w[i] + value("coulomb") * direction +
                     weight * std::sin(path.goal_rad()[i]));
  }
  return torque;
}

Recording planned_recording(const Motion& motion, const Change& change, const Recording& base,
                            const FittedSetup& fitted) {
  Recording r;
  r.name = kRecordedFile;
  r.path = kRecordedFile;
  r.planned = true;
  r.setup = base.setup;
  for (const auto& [key, factor] : change.factors) {
    SetupValue& v = r.setup.values[key];
    v = {v.value * factor, v.sigma * factor};
  }
  const std::vector<double>& goal = motion.path.goal_rad();
  r.time_s = motion.path.time_s();
  const std::size_t count = r.time_s.size();
  for (const auto& [channel, values] : base.channels) r.channels[channel].assign(count, 0.0);
  r.channels["position"].assign(count, goal.front());
  if (r.setup.law == DriveLaw::kTorque) {
    r.channels["torque"] = torque_to_follow(motion.path, r, fitted);
    r.channels["position"] = goal;
    return r;
  }
  r.channels["position_goal"] = goal;
  if (base.has("velocity_goal"))
    r.channels["velocity_goal"] = slopes(r.time_s, goal, 1.5 * (r.time_s[1] - r.time_s[0]));
  if (base.has("enable")) r.channels["enable"].assign(count, 1.0);
  const std::vector<double> enable = motion.path.enable();
  if (!enable.empty()) r.channels["enable"] = enable;
  if (base.has("supply_voltage")) {
    double sum = 0, there = 0;
    for (const double v : base.channels.at("supply_voltage")) {
      if (std::isfinite(v)) sum += v, there += 1;
    }
    r.channels["supply_voltage"].assign(count, there > 0 ? sum / there : 0);
  }
  if (change.supply_V) r.channels["supply_voltage"].assign(count, *change.supply_V);
  return r;
}

}  // namespace

std::vector<Candidate> pendulum_candidates(const std::vector<DataSet>& sets,
                                           const FittedSetup& fitted) {
  const DataSet& base_set = sets.front();
  const Recording& base = base_set.recordings.front();
  const PendulumSafety safe = pendulum_safety(sets);
  if (!(safe.span_rad() > 0) || !(safe.speed_rad_s > 0) || !(safe.step_s > 0)) return {};
  std::vector<Candidate> candidates;
  const auto add = [&](const Motion& motion, const Change& change) {
    const std::string text = motion.text + (change.text.empty() ? "" : ", " + change.text);
    Candidate c{text, motion.effort + change.effort, base_set};
    c.set.recordings = {planned_recording(motion, change, base, fitted)};
    const double room = 0.1 * safe.span_rad();
    c.safe["position"] = {safe.position_low_rad - room, safe.position_high_rad + room};
    if (safe.torque_Nm > 0 && !change.factors.contains("payload_mass")) {
      c.safe["torque"] = {-1.2 * safe.torque_Nm, 1.2 * safe.torque_Nm};
    }
    candidates.push_back(std::move(c));
  };
  const std::vector<Motion> motions = Motions(safe).take();
  const std::vector<Change> changes = changes_of(base_set, base);
  for (const Motion& motion : motions) add(motion, {});
  for (const Motion& motion : motions) {
    if (!motion.with_changes) continue;
    for (const Change& change : changes) add(motion, change);
  }
  return candidates;
}

}  // namespace hoof::tools
