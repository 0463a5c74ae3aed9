#include "sim/experiments/sinkage.h"

#include <algorithm>
#include <cmath>

namespace hoof::sim {
namespace {

constexpr double kStandardGravity_m_s2 = 9.81;  // the paper's

}  // namespace

SinkageSettings read_sinkage(const Reader& section) {
  Reader s = section;
  SinkageSettings settings;
  double load_kg = 0;
  s.number("load_kg", load_kg, kKilogram, 0.01, 10000);
  settings.load_N = load_kg * kStandardGravity_m_s2;
  if (s.has("load_N")) s.number("load_N", settings.load_N, kNewton, 0.1, 1e5);
  std::string as;
  s.choice("load_as", as, {"force", "mass"});
  settings.load_as = as == "force" ? LoadAs::kForce : LoadAs::kMass;
  s.number("speed_m_s", settings.speed_m_s, kMetrePerSecond, 0.001, 2);
  s.number("toe_deg", settings.toe_rad, kDegree, 0, 40);
  s.number("start_height_mm", settings.start_height_m, kMillimetre, 1, 500);
  s.number("rest_speed_mm_s", settings.rest_speed_m_s, {"mm_s", 1.0, 1e3}, 0.001, 100);
  s.number("rest_time_ms", settings.rest_time_s, kMillisecond, 1, 1000);
  s.number("time_limit_s", settings.time_limit_s, kSecond, 0.01, 60);
  return settings;
}

Sinkage::Sinkage(const SinkageSettings& settings, std::unique_ptr<Plant> plant)
    : Experiment(std::move(plant)),
      settings_(settings),
      rig_(dynamic_cast<SinkageRig&>(this->plant().rig())) {
  for (int body = 0; body < rig_.body_count(); ++body) {
    const double lift_m = rig_.pose(body).p_WB_m.z() - sole_z_m();
    for (const Eigen::Vector3d& v : rig_.mesh(body).vertices_m) {
      below_sole_m_ = std::max(below_sole_m_, -(v.z() + lift_m));
    }
  }
  rig_.hold();
}

void Sinkage::foot_ready() {
  if (phase_ != Phase::kPreparing) return;
  phase_ = Phase::kLowering;
  lowered_from_m_ = sole_z_m();
  rig_.lower(settings_.speed_m_s);
}

double Sinkage::depth_m() const {
  return phase_ == Phase::kLoaded || phase_ == Phase::kFinished ? contact_z_m_ - sole_z_m() : 0;
}

void Sinkage::after_interval() {
  const double now_s = time_s();
  if (phase_ == Phase::kLowering && plant().touched()) {
    phase_ = Phase::kLoaded;
    contact_z_m_ = sole_z_m();
    contact_time_s_ = slow_since_s_ = now_s;
    rig_.release();
    return;
  }
  if (phase_ != Phase::kLoaded) return;
  max_depth_m_ = std::max(max_depth_m_, depth_m());
  if (std::abs(rig_.foot_velocity_m_s().z()) > settings_.rest_speed_m_s) slow_since_s_ = now_s;
  rested_ = now_s - slow_since_s_ >= settings_.rest_time_s;
  if (rested_ || now_s - contact_time_s_ >= settings_.time_limit_s) phase_ = Phase::kFinished;
}

double Sinkage::progress() const {
  // Lowering is a known way; how long it sinks is not, so the loaded part creeps towards the end.
  if (phase_ == Phase::kFinished) return 1;
  if (phase_ == Phase::kPreparing) return 0;
  if (phase_ == Phase::kLowering) {
    return 0.1 * std::clamp(1 - sole_z_m() / lowered_from_m_, 0.0, 1.0);
  }
  constexpr double kTypicalRest_s = 0.3;
  const double loaded_s = time_s() - contact_time_s_;
  return 0.1 + 0.9 * std::min(0.98, loaded_s / (loaded_s + 0.3 * kTypicalRest_s));
}

}  // namespace hoof::sim
