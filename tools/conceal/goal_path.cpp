#include "tools/conceal/goal_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools::conceal {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// 0 to 1 with no speed and no acceleration at both ends (Flash and Hogan 1985).
double least_jerk(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

/// Integral of the clamped ramp, for rounding corners: the mean of a ramp over a window.
double ramp_integral(double x) {
  if (x <= 0.0) return 0.0;
  return x < 1.0 ? 0.5 * x * x : x - 0.5;
}

double rounded_ramp(double t_s, double duration_s) {
  const double half = std::min(0.05, 0.25 * duration_s) / duration_s;
  const double x = t_s / duration_s;
  return (ramp_integral(x + half) - ramp_integral(x - half)) / (2.0 * half);
}

}  // namespace

double GoalPath::value(double t_s) const {
  const double t = std::max(t_s, 0.0);
  double waves = 0.0;
  for (const Sine& s : sines) {
    waves += s.amplitude * std::sin(kTurn * s.frequency_Hz * t + s.phase);
  }
  for (const Chirp& c : chirps) {
    // Exponential sweep: equal time in each octave; held at its last rate afterwards.
    const double growth = std::log(c.to_Hz / c.from_Hz) / c.duration_s;
    const double swept = std::min(t, c.duration_s);
    const double turns = c.from_Hz * std::expm1(growth * swept) / growth + c.to_Hz * (t - swept);
    // Less at high rates, so that speed and not only acceleration stays bounded.
    const double rate = c.from_Hz * std::exp(growth * swept);
    waves += c.amplitude * std::sqrt(c.from_Hz / rate) * std::sin(kTurn * turns);
  }
  if (fade_in_s > 0.0) waves *= least_jerk(t / fade_in_s);
  double moved = 0.0;
  for (const Move& m : moves) {
    moved += m.by * (m.smooth ? least_jerk((t - m.start_s) / m.duration_s)
                              : rounded_ramp(t - m.start_s, m.duration_s));
  }
  return offset + waves + moved;
}

double GoalPath::rate(double t_s) const {
  constexpr double kStep_s = 1e-4;
  return (value(t_s + kStep_s) - value(t_s - kStep_s)) / (2.0 * kStep_s);
}

void GoalPath::scale(double factor) {
  for (Sine& s : sines) s.amplitude *= factor;
  for (Chirp& c : chirps) c.amplitude *= factor;
  for (Move& m : moves) m.by *= factor;
}

}  // namespace hoof::tools::conceal
