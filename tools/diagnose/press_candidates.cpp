// Presses of plates in sand and on a block that could be made on the rig of some recordings.
#include <algorithm>
#include <cmath>

#include "tools/diagnose/experiment_candidates.h"
#include "tools/diagnose/series.h"
#include "tools/report/display_unit.h"

namespace hoof::tools {
namespace {

/// Decades of odds that a change of the rig must be worth; sand is prepared anew for each press.
constexpr double kOtherPlate = 0.5, kOtherPlace = 0.5, kBlock = 0.5;
constexpr double kMostSamples = 4000;
/// Above the force seen: the rig bears a little more than it was asked for.
constexpr double kForceRoom = 1.2;

std::string number(double value) {
  return format_significant(value, 3);
}

std::string millimetres(double value_m) {
  return number(1e3 * value_m) + " mm";
}

/// What the recordings show to be possible.
struct PressRange {
  double deepest_m = 0, force_N = 0, speed_m_s = 0, step_s = 0;
};

PressRange range_of_presses(const std::vector<DataSet>& sets) {
  PressRange range;
  Series speeds, steps;
  for (const DataSet& set : sets) {
    for (const Recording& r : set.recordings) {
      for (const double f : valid_of(r.channels.at("force"))) {
        range.force_N = std::max(range.force_N, f);
      }
      if (set.rig != RigKind::kPlateSand) continue;
      const double surface_m = r.setup.value_or("surface_height", 0);
      const auto& height_m = r.channels.at("position");
      for (std::size_t i = 1; i < height_m.size(); ++i) {
        const double depth_m = surface_m - height_m[i];
        const double step_s = r.time_s[i] - r.time_s[i - 1];
        if (depth_m > range.deepest_m) range.deepest_m = depth_m;
        steps.push_back(step_s);
        const double speed_m_s = (height_m[i - 1] - height_m[i]) / step_s;
        if (depth_m > 0 && speed_m_s > 0) speeds.push_back(speed_m_s);
      }
    }
  }
  range.speed_m_s = median(speeds);
  range.step_s = median(steps);
  return range;
}

/// Heights of the carriage, put together from moves at constant speed.
class DepthPath {
 public:
  DepthPath(double above_m, double step_s) : step_s_(step_s), depths_m_{-above_m} {}

  DepthPath& to(double depth_m, double speed_m_s) {
    const double from_m = depths_m_.back();
    const int count = samples(std::abs(depth_m - from_m) / speed_m_s);
    for (int i = 1; i <= count; ++i) depths_m_.push_back(from_m + (depth_m - from_m) * i / count);
    return *this;
  }
  DepthPath& hold(double time_s) {
    depths_m_.insert(depths_m_.end(), static_cast<std::size_t>(samples(time_s)), depths_m_.back());
    return *this;
  }

  void write(Recording& r, double surface_m) const {
    for (std::size_t i = 0; i < depths_m_.size(); ++i) {
      r.time_s.push_back(1e-9 * std::round(1e9 * step_s_ * static_cast<double>(i)));
      r.channels["position"].push_back(surface_m - depths_m_[i]);
    }
    r.channels["force"].assign(depths_m_.size(), 0.0);
  }

 private:
  int samples(double time_s) const {
    return std::max(1, static_cast<int>(std::lround(time_s / step_s_)));
  }

  double step_s_;
  std::vector<double> depths_m_;
};

class Presses {
 public:
  Presses(const std::vector<DataSet>& sets, const DataSet& sand)
      : sand_(sand), base_(sand.recordings.front()), range_(range_of_presses(sets)) {}

  std::vector<Candidate> take() {
    const double deep = range_.deepest_m, speed = range_.speed_m_s;
    if (!(deep > 0) || !(speed > 0) || !(range_.force_N > 0)) return {};
    add("press to " + millimetres(deep) + " again", 0, path(speed).to(deep, speed));
    for (const double factor : {10.0, 0.1}) {
      add("press to " + millimetres(deep) + " at " + millimetres(factor * speed) +
              "/s in place of " + millimetres(speed) + "/s",
          0, path(factor * speed).to(deep, factor * speed).to(-above(), factor * speed));
    }
    cycles(deep, speed);
    repeated(deep, speed);
    add("press to " + millimetres(deep) + " and wait there for 30 s", 0,
        path(speed, 30).to(deep, speed).hold(30).to(-above(), speed));
    add("press slowly, at " + millimetres(0.2 * speed) + "/s, through the first " +
            millimetres(0.15 * deep),
        0, path(0.2 * speed).to(0.15 * deep, 0.2 * speed).to(-above(), speed));
    other_plates(deep, speed);
    near_wall(deep, speed);
    on_block();
    return std::move(candidates_);
  }

 private:
  double above() const { return 0.05 * range_.deepest_m; }

  /// @param idle_s of waiting, beside the way there and back at this speed
  DepthPath path(double speed_m_s, double idle_s = 0) const {
    const double time_s = 3 * range_.deepest_m / speed_m_s + idle_s;
    return {above(), std::max(std::min(range_.step_s, time_s / 600), time_s / kMostSamples)};
  }

  void add(const std::string& action, double effort, const DepthPath& path,
           const std::map<std::string, double>& factors = {}) {
    Candidate c{action, effort, sand_};
    Recording r = blank();
    for (const auto& [key, factor] : factors) {
      SetupValue& v = r.setup.values[key];
      v = {v.value * factor, v.sigma * factor};
    }
    path.write(r, base_.setup.value_or("surface_height", 0));
    c.set.recordings = {std::move(r)};
    c.safe["force"] = {0, kForceRoom * range_.force_N};
    candidates_.push_back(std::move(c));
  }

  Recording blank() const {
    Recording r;
    r.name = r.path = kRecordedFile;
    r.planned = true;
    r.setup = base_.setup;
    return r;
  }

  void cycles(double deep, double speed) {
    DepthPath steps = path(speed, 4 * deep / speed);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      steps.to(share * deep, speed).to(0.5 * share * deep, speed);
    }
    steps.to(deep, speed).to(-above(), speed);
    add("press to a quarter, half, three quarters and all of " + millimetres(deep) +
            ", each time drawing back by half and pressing again",
        0, steps);
  }

  void repeated(double deep, double speed) {
    DepthPath ten = path(speed, 14 * deep / speed);
    for (int i = 0; i < 10; ++i) ten.to(0.7 * deep, speed).to(-above(), speed);
    add("press ten times to " + millimetres(0.7 * deep) +
            " in the same place, without preparing the sand between",
        0, ten);
  }

  void other_plates(double deep, double speed) {
    const bool disc = base_.setup.find("diameter") != nullptr;
    const char* key = disc ? "diameter" : "width";
    const double size_m = base_.setup.value_or(key, 0);
    for (const double factor : {0.4, 0.6, 1.6, 2.5}) {
      std::map<std::string, double> factors = {{key, factor}};
      if (!disc) factors["length"] = factor;
      const std::string plate = "press a plate of " + millimetres(factor * size_m) + " " + key +
                                " in place of " + millimetres(size_m) + " to ";
      for (const double further : {0.6, 1.0, 1.5}) {
        const double to = further * deep;
        add(plate + millimetres(to), kOtherPlate, path(speed).to(to, speed).to(-above(), speed),
            factors);
      }
    }
    for (const double further : {1.2, 1.5}) {  // as far as the force allows
      add("press deeper, to " + millimetres(further * deep), 0,
          path(speed).to(further * deep, speed).to(-above(), speed));
    }
  }

  void near_wall(double deep, double speed) {
    const SetupValue* wall = base_.setup.find("wall_distance");
    if (wall == nullptr) return;
    for (const double factor : {0.5, 2.0}) {
      add("press to " + millimetres(deep) + ", " + millimetres(factor * wall->value) +
              " from the wall in place of " + millimetres(wall->value),
          kOtherPlace, path(speed).to(deep, speed).to(-above(), speed),
          {{"wall_distance", factor}});
    }
  }

  /// Without a height of contact: that is what the lightly loaded samples say.
  void on_block() {
    Candidate c{"press on a rigid block up to " + number(range_.force_N) + " N and let go", kBlock,
                sand_};
    c.set.rig = RigKind::kRigidPress;
    c.set.setup.values.clear();
    Recording r = blank();
    r.setup.values.clear();
    constexpr int kHalf = 400;
    for (int i = 0; i <= 2 * kHalf; ++i) {
      r.time_s.push_back(0.025 * i);
      r.channels["force"].push_back(range_.force_N * (1 - std::abs(i - kHalf) / double(kHalf)));
    }
    r.channels["position"].assign(r.time_s.size(), 0.0);
    c.set.recordings = {std::move(r)};
    candidates_.push_back(std::move(c));
  }

  const DataSet& sand_;
  const Recording& base_;
  PressRange range_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<Candidate> press_candidates(const std::vector<DataSet>& sets) {
  for (const DataSet& set : sets) {
    if (set.rig == RigKind::kPlateSand) return Presses(sets, set).take();
  }
  return {};
}

std::vector<Candidate> experiment_candidates(const std::vector<DataSet>& sets,
                                             const FittedSetup& fitted) {
  switch (sets.front().rig) {
    case RigKind::kServoPendulum:
      return pendulum_candidates(sets, fitted);
    case RigKind::kPlateSand:
    case RigKind::kRigidPress:
      return press_candidates(sets);
    default:
      return {};
  }
}

}  // namespace hoof::tools
