#include "tools/diagnose/goal_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools {

using std::numbers::pi;

int GoalPath::samples(double time_s) const {
  return std::max(1, static_cast<int>(std::lround(time_s / step_s_)));
}

void GoalPath::add(double goal_rad, bool on) {
  goal_rad_.push_back(goal_rad);
  on_.push_back(on ? 1 : 0);
}

GoalPath& GoalPath::hold(double time_s) {
  const double at_rad = last_rad();
  for (int i = 0; i < samples(time_s); ++i) add(at_rad);
  return *this;
}

GoalPath& GoalPath::ramp(double to_rad, double speed_rad_s) {
  const double from_rad = last_rad();
  const int count = samples(std::abs(to_rad - from_rad) / speed_rad_s);
  for (int i = 1; i <= count; ++i) add(from_rad + (to_rad - from_rad) * i / count);
  return *this;
}

GoalPath& GoalPath::ease(double to_rad, double speed_rad_s) {
  const double from_rad = last_rad();
  const int count = samples(0.5 * pi * std::abs(to_rad - from_rad) / speed_rad_s);
  for (int i = 1; i <= count; ++i) {
    add(from_rad + 0.5 * (to_rad - from_rad) * (1 - std::cos(pi * i / count)));
  }
  return *this;
}

GoalPath& GoalPath::jump(double to_rad) {
  add(to_rad);
  return *this;
}

GoalPath& GoalPath::sine(double amplitude_rad, double frequency_Hz, int cycles) {
  const double middle_rad = last_rad();
  const int count = samples(cycles / frequency_Hz);
  for (int i = 1; i <= count; ++i) {
    add(middle_rad + amplitude_rad * std::sin(2 * pi * cycles * i / count));
  }
  return *this;
}

GoalPath& GoalPath::chirp(double amplitude_rad, double from_Hz, double to_Hz, double time_s,
                          double speed_rad_s) {
  const double middle_rad = last_rad();
  const double growth = std::log(to_Hz / from_Hz);
  const int count = samples(time_s);
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const double rate_Hz = from_Hz * std::exp(growth * share);
    // Ends at rest in the middle.
    const double fade = std::min(1.0, 10 * (1 - share));
    const double most_rad = std::min(amplitude_rad, speed_rad_s / (2 * pi * rate_Hz));
    const double phase = 2 * pi * time_s / growth * (rate_Hz - from_Hz);
    add(middle_rad + fade * most_rad * std::sin(phase));
  }
  return *this;
}

GoalPath& GoalPath::off(double time_s) {
  const double at_rad = last_rad();
  for (int i = 0; i < samples(time_s); ++i) add(at_rad, false);
  return *this;
}

std::vector<double> GoalPath::time_s() const {
  std::vector<double> time_s;
  // Rounded to nanoseconds: what is written is what was simulated.
  for (std::size_t i = 0; i < goal_rad_.size(); ++i) {
    time_s.push_back(1e-9 * std::round(1e9 * step_s_ * static_cast<double>(i)));
  }
  return time_s;
}

std::vector<double> GoalPath::enable() const {
  const bool always = std::all_of(on_.begin(), on_.end(), [](double on) { return on > 0.5; });
  return always ? std::vector<double>() : on_;
}

}  // namespace hoof::tools
