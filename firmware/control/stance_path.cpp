#include "firmware/control/stance_path.h"

namespace hoof::firmware::control {

void StancePath::reset() {
  *this = StancePath(settings_);
}

void StancePath::set_frequency(float frequency_Hz) {
  if (frequency_Hz == to_Hz_) return;
  constexpr float kRampPeriods = 0.4f;
  from_Hz_ = rate_Hz_;
  to_Hz_ = frequency_Hz;
  ramp_s_ = 0.0f;
  ramp_length_s_ = kRampPeriods / (from_Hz_ > to_Hz_ ? from_Hz_ : to_Hz_);
}

void StancePath::advance(float dt_s) {
  if (ramp_s_ < ramp_length_s_) {
    ramp_s_ += dt_s;
    const float u = clamp(ramp_s_ / ramp_length_s_, 0.0f, 1.0f);
    const float change = to_Hz_ - from_Hz_;
    rate_Hz_ = u >= 1.0f ? to_Hz_ : from_Hz_ + change * u * u * (3.0f - 2.0f * u);
    rate_slope_Hz_s_ = change * 6.0f * u * (1.0f - u) / ramp_length_s_;
  }
  phase_ += static_cast<std::uint32_t>(rate_Hz_ * dt_s * 0x1p32f + 0.5f);
}

PlaneVector StancePath::deepest_m() const {
  return {0.0f, settings_.centre_above_sand_m - settings_.hip_above_sand_m - settings_.semi_z_m};
}

PathPoint StancePath::point() const {
  const SinCos p = sin_cos(phase_cycles() * kTwoPi);
  const float w = rate_Hz_ * kTwoPi;
  const float w_dot = rate_slope_Hz_s_ * kTwoPi;
  const float a = settings_.semi_x_m;
  const float b = settings_.semi_z_m;
  const float centre_z = settings_.centre_above_sand_m - settings_.hip_above_sand_m;
  return {{a * p.cos, centre_z - b * p.sin},
          {-a * p.sin * w, -b * p.cos * w},
          {-a * (p.cos * w * w + p.sin * w_dot), b * (p.sin * w * w - p.cos * w_dot)}};
}

}  // namespace hoof::firmware::control
