#include "sim/experiments/traction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::sim {
namespace {

// The foot has left the sand when nothing has touched it for this long: between two grains it may
// be free for some milliseconds.
constexpr double kLeft_s = 0.05;
// A grain or two that ride along between the toes weigh up to 0.2 N (a 23 mm grain is 0.17 N); a
// foot that stands in sand feels tens of newtons.
constexpr double kFree_N = 2;
// A prescribed foot gathers speed over this share of a turn, above the sand.
constexpr double kRunUp_turns = 0.1;

}  // namespace

FootPoint StanceEllipse::at(double turns) const {
  const double phi = 2 * std::numbers::pi * turns;
  return {half_length_m * std::sin(phi), centre_height_m + half_height_m * std::cos(phi)};
}

double StanceEllipse::distance_m(const FootPoint& p) const {
  // Golden section around the best of some phases: the distance has at most two minima.
  const auto distance = [&](double turns) {
    const FootPoint q = at(turns);
    return std::hypot(p.x_m - q.x_m, p.z_m - q.z_m);
  };
  constexpr int kPhases = 48;
  double best = 0;
  for (int i = 1; i < kPhases; ++i) {
    if (distance(double(i) / kPhases) < distance(best)) best = double(i) / kPhases;
  }
  double low = best - 1.0 / kPhases, high = best + 1.0 / kPhases;
  for (int i = 0; i < 40; ++i) {
    const double a = low + 0.381966 * (high - low), b = high - 0.381966 * (high - low);
    (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
  }
  return distance(0.5 * (low + high));
}

TractionSettings read_traction(const Reader& section) {
  Reader s = section;
  TractionSettings settings;
  std::string drive;
  s.choice("drive", drive, {"firmware", "prescribed"});
  settings.prescribed = drive == "prescribed";
  s.number("frequency_Hz", settings.frequency_Hz, kHertz, 0.01, 2);
  s.number("toe_deg", settings.toe_rad, kDegree, 0, 40);
  s.number("ellipse_half_length_mm", settings.ellipse.half_length_m, kMillimetre, 1, 500);
  s.number("ellipse_half_height_mm", settings.ellipse.half_height_m, kMillimetre, 1, 500);
  s.number("ellipse_centre_height_mm", settings.ellipse.centre_height_m, kMillimetre, -200, 500);
  s.integer("cycles", settings.cycles, 1, 100);
  return settings;
}

Traction::Traction(const TractionSettings& settings, std::unique_ptr<Plant> plant)
    : Experiment(std::move(plant)),
      settings_(settings),
      prescribed_(settings.prescribed ? &dynamic_cast<PrescribedRig&>(this->plant().rig())
                                      : nullptr) {}

void Traction::foot_ready() {
  if (moving_) return;
  moving_ = true;
  started_s_ = time_s();
}

/// The paper's motion at constant frequency, after a run-up at constant angular acceleration.
double Traction::prescribed_turns(double time_s) const {
  const double t = time_s - started_s_;
  const double run_up_s = 2 * kRunUp_turns / settings_.frequency_Hz;
  if (t < run_up_s) return 0.5 * settings_.frequency_Hz * t * t / run_up_s;
  return kRunUp_turns + settings_.frequency_Hz * (t - run_up_s);
}

void Traction::before_interval() {
  if (prescribed_ && moving_) {
    const double end_s = time_s() + plant().settings().exchange_s;
    prescribed_->move_to(settings_.ellipse.at(prescribed_turns(end_s)));
  }
}

double Traction::depth_m() const {
  return std::max(0.0, -plant().rig().foot_position_m().z());
}

void Traction::after_interval() {
  if (!moving_) return;
  const double now_s = time_s();
  if (plant().ground_force_N().norm() > kFree_N) {
    last_touch_s_ = now_s;
    if (!in_stance_) phase_ = Phase::kLoaded;
    in_stance_ = true;
  } else if (in_stance_ && now_s - last_touch_s_ > kLeft_s) {
    in_stance_ = false;
    if (++stances_ == settings_.cycles) phase_ = Phase::kFinished;
  }
  if (in_stance_) max_depth_m_ = std::max(max_depth_m_, depth_m());
  // A gait that never touches the ground (or never leaves it) ends all the same.
  if (now_s - started_s_ > (settings_.cycles + 1.5) / settings_.frequency_Hz + 2) {
    phase_ = Phase::kFinished;
  }
}

double Traction::progress() const {
  if (phase_ == Phase::kFinished) return 1;
  if (!moving_) return 0;
  return std::min(0.98,
                  (time_s() - started_s_) * settings_.frequency_Hz / (settings_.cycles + 0.2));
}

}  // namespace hoof::sim
