#include "firmware/control/stance_path.h"

namespace hoof::firmware::control {

namespace {

float larger(float a, float b) {
  return a > b ? a : b;
}

/// The part of a cycle in counts of 2^-32.
std::uint32_t counts(float cycles) {
  float part = cycles - static_cast<float>(static_cast<std::int32_t>(cycles));
  if (part < 0.0f) part += 1.0f;
  return part < 1.0f ? static_cast<std::uint32_t>(part * 0x1p32f) : 0u;
}

}  // namespace

void StancePath::reset(float phase_cycles) {
  phase_ = counts(phase_cycles);
  rate_Hz_ = rate_slope_Hz_s_ = 0.0f;
  from_Hz_ = from_slope_Hz_s_ = to_Hz_ = 0.0f;
  ramp_s_ = ramp_length_s_ = brake_length_s_ = 0.0f;
}

void StancePath::set_frequency(float frequency_Hz) {
  if (frequency_Hz == to_Hz_) return;
  constexpr float kRampPeriods = 0.4f;
  constexpr float kBrakeShare = 0.25f;  // bends as sharply as the steepest smooth step
  const float fastest_Hz = larger(rate_Hz_, larger(to_Hz_, frequency_Hz));
  from_Hz_ = rate_Hz_;
  from_slope_Hz_s_ = rate_slope_Hz_s_;
  to_Hz_ = frequency_Hz;
  ramp_s_ = 0.0f;
  ramp_length_s_ = kRampPeriods / fastest_Hz;
  brake_length_s_ = kBrakeShare * ramp_length_s_;
  // A falling rate is caught before it is negative: it falls by slope * length / 2.
  if (from_slope_Hz_s_ * brake_length_s_ < -2.0f * from_Hz_) {
    brake_length_s_ = -2.0f * from_Hz_ / from_slope_Hz_s_;
  }
}

/// rate = braking part (from the old rate, its slope falling linearly to zero) + smooth step from
/// where that ends to the new rate. With the step at least as long as the braking, the sum is never
/// negative: for a rising rate u (2 - u) >= u^2 (3 - 2 u).
void StancePath::advance(float dt_s) {
  if (ramp_s_ < ramp_length_s_) {
    ramp_s_ += dt_s;
    const float u = clamp(ramp_s_ / ramp_length_s_, 0.0f, 1.0f);
    const bool braking = ramp_s_ < brake_length_s_;
    const float v = braking ? ramp_s_ / brake_length_s_ : 1.0f;
    const float rise_Hz = from_slope_Hz_s_ * brake_length_s_;  // twice that of the braking part
    const float change = to_Hz_ - (from_Hz_ + 0.5f * rise_Hz);
    const float rate_Hz =
        from_Hz_ + rise_Hz * v * (1.0f - 0.5f * v) + change * u * u * (3.0f - 2.0f * u);
    rate_Hz_ = u >= 1.0f ? to_Hz_ : larger(rate_Hz, 0.0f);
    rate_slope_Hz_s_ =
        from_slope_Hz_s_ * (1.0f - v) + change * 6.0f * u * (1.0f - u) / ramp_length_s_;
  }
  phase_ += static_cast<std::uint32_t>(rate_Hz_ * dt_s * 0x1p32f + 0.5f);
}

PlaneVector StancePath::deepest_m() const {
  return {0.0f, settings_.centre_above_sand_m - settings_.hip_above_sand_m - settings_.semi_z_m};
}

float StancePath::height_m(float phase_cycles) const {
  return settings_.centre_above_sand_m - settings_.semi_z_m * sin_cos(phase_cycles * kTwoPi).sin;
}

/// From one passing of the deepest point (phase 0.25) to the next, the height rises and then falls:
/// between two points above the sand there is none below it.
bool StancePath::above_sand_for(float time_s) const {
  constexpr float kDeepest = 0.25f;
  const float phase = phase_cycles();
  const float since = phase >= kDeepest ? phase - kDeepest : phase - kDeepest + 1.0f;
  const float later = since + larger(rate_Hz_, to_Hz_) * time_s;
  return later < 1.0f && height_m(phase) > 0.0f && height_m(later + kDeepest) > 0.0f;
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
