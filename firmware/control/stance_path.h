// The elliptical stance path of the source paper, played at any frequency.
#pragma once

#include <cstdint>

#include "firmware/control/leg_kinematics.h"
#include "firmware/control/settings.h"

namespace hoof::firmware::control {

/// Sole point in the hip's frame: x forward, z up from the hip.
struct PathPoint {
  PlaneVector position_m;
  PlaneVector velocity_m_s;
  PlaneVector acceleration_m_s2;
};

/// x = a cos(phase), z = centre - b sin(phase): the foot moves to -x through the lower half, phase
/// 0 to pi, and comes back above the sand. Play starts at the top (phase 3 pi/2), clear of the
/// sand.
class StancePath {
 public:
  explicit StancePath(const PathSettings& settings) : settings_(settings) {}

  /// Back to the top, standing still.
  void reset();

  /// New cycles per second; 0 stops where the path then is. The rate changes along a smooth step
  /// (3 u^2 - 2 u^3) over 0.4 periods, 0.2 cycles from standstill: full speed before the foot is
  /// down, and no step of acceleration unless ordered anew during a change.
  void set_frequency(float frequency_Hz);

  /// One control tick. The phase is counted in 2^-32 cycles, so it never drifts or loses digits.
  void advance(float dt_s);

  PathPoint point() const;
  PlaneVector deepest_m() const;
  float phase_cycles() const { return static_cast<float>(phase_ >> 8) * 0x1p-24f; }
  float rate_Hz() const { return rate_Hz_; }
  bool at_rest() const { return rate_Hz_ == 0.0f && ramp_s_ >= ramp_length_s_; }

 private:
  static constexpr std::uint32_t kTop = 0xC0000000u;  // three quarters of a cycle

  PathSettings settings_;
  std::uint32_t phase_ = kTop;
  float rate_Hz_ = 0.0f;
  float rate_slope_Hz_s_ = 0.0f;
  float from_Hz_ = 0.0f;
  float to_Hz_ = 0.0f;
  float ramp_s_ = 0.0f;
  float ramp_length_s_ = 0.0f;
};

}  // namespace hoof::firmware::control
