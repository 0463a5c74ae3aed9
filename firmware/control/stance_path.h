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
/// 0 to pi, and comes back above the sand. Play starts where the settings say: by default at the
/// top (phase 3 pi/2), clear of the sand.
class StancePath {
 public:
  explicit StancePath(const PathSettings& settings) : settings_(settings) { reset(); }

  /// Back to the start, standing still.
  void reset() { reset(settings_.start_phase_cycles); }

  /// To any phase, in cycles (whole cycles do not count), standing still. The point jumps there:
  /// whoever commands a leg takes it to point() first.
  void reset(float phase_cycles);

  /// New cycles per second, not negative; 0 stops where the path then is. The rate changes along a
  /// smooth step (3 u^2 - 2 u^3) over 0.4 periods, 0.2 cycles from standstill: full speed before
  /// the foot is down. Ordered anew during a change, what slope the rate then has is led to zero
  /// over a quarter of that time while the new step begins: acceleration never jumps, and the rate
  /// never falls below zero.
  void set_frequency(float frequency_Hz);

  /// One control tick. The phase is counted in 2^-32 cycles, so it never drifts or loses digits.
  void advance(float dt_s);

  PathPoint point() const;
  PlaneVector deepest_m() const;

  /// The point is below the level sand.
  bool below_sand() const { return height_m(phase_cycles()) < 0.0f; }
  /// The point is above the level sand now and for this long, at the present rate or the one that
  /// is being changed to, whichever is higher.
  bool above_sand_for(float time_s) const;

  float phase_cycles() const { return static_cast<float>(phase_ >> 8) * 0x1p-24f; }
  float rate_Hz() const { return rate_Hz_; }
  bool at_rest() const { return rate_Hz_ == 0.0f && ramp_s_ >= ramp_length_s_; }

 private:
  float height_m(float phase_cycles) const;  // above the level sand

  PathSettings settings_;
  std::uint32_t phase_ = 0;
  float rate_Hz_ = 0.0f;
  float rate_slope_Hz_s_ = 0.0f;
  float from_Hz_ = 0.0f;  // rate and slope when the change was ordered
  float from_slope_Hz_s_ = 0.0f;
  float to_Hz_ = 0.0f;
  float ramp_s_ = 0.0f;
  float ramp_length_s_ = 0.0f;
  float brake_length_s_ = 0.0f;  // in which the old slope is led to zero
};

}  // namespace hoof::firmware::control
