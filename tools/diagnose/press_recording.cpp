#include "tools/diagnose/press_recording.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/noise.h"

namespace hoof::tools {
namespace {

constexpr std::size_t kSideSamples = 3;
constexpr double kMostSide_s = 0.1;      // of the line that tells the speed
constexpr double kMostSteadySide_s = 5;  // and where that is steady
constexpr double kSpeedDoubt = 0.02;     // of the largest speed: what that line should not exceed
constexpr double kSteadyDoubt = 0.001;   // the same where the speed is steady
constexpr double kNoises = 3;
constexpr double kStraight = 1;  // deviations of what a line through noise leaves

/// Missing values on the straight line between their neighbours; beyond the ends as the ends.
std::vector<double> bridged(std::span<const double> time_s, std::span<const double> values) {
  std::vector<double> result(values.begin(), values.end());
  std::size_t last = values.size();  // last sample that is there
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const std::size_t from = last == values.size() ? 0 : last + 1;
    for (std::size_t j = from; j < i; ++j) {
      if (last == values.size()) {
        result[j] = values[i];
        continue;
      }
      const double share = (time_s[j] - time_s[last]) / (time_s[i] - time_s[last]);
      result[j] = values[last] + share * (values[i] - values[last]);
    }
    last = i;
  }
  const double end = last == values.size() ? 0.0 : values[last];
  for (std::size_t j = last == values.size() ? 0 : last + 1; j < values.size(); ++j) {
    result[j] = end;
  }
  return result;
}

/// Value and slope at time_s[at] of the polynomial through samples [first, last].
struct Fitted {
  double value = 0, slope = 0;
};

Fitted fit_polynomial(std::span<const double> time_s, std::span<const double> values,
                      std::size_t at, std::size_t first, std::size_t last, int degree) {
  const auto count = static_cast<Eigen::Index>(last - first + 1);
  degree = std::min(degree, static_cast<int>(count) - 1);
  if (degree < 1) return {values[at], 0};
  const double scale_s = time_s[last] - time_s[first];
  Eigen::MatrixXd powers(count, degree + 1);
  Eigen::VectorXd heights(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t sample = first + static_cast<std::size_t>(i);
    const double x = (time_s[sample] - time_s[at]) / scale_s;
    for (int power = 0; power <= degree; ++power) powers(i, power) = std::pow(x, power);
    heights(i) = values[sample] - values[at];
  }
  const Eigen::VectorXd fit = powers.colPivHouseholderQr().solve(heights);
  return {values[at] + fit(0), fit(1) / scale_s};
}

/// Largest speed over a few samples.
double fastest(std::span<const double> time_s, std::span<const double> height_m) {
  double fastest_m_s = 0;
  for (std::size_t i = 2 * kSideSamples; i < height_m.size(); ++i) {
    const std::size_t before = i - 2 * kSideSamples;
    fastest_m_s = std::max(fastest_m_s,
                           std::abs(height_m[i] - height_m[before]) / (time_s[i] - time_s[before]));
  }
  return fastest_m_s;
}

/// Fewest samples on each side that tell the speed well enough: h samples of noise sigma, dt apart,
/// leave a slope's deviation of sigma / (dt sqrt(h (h + 1) (2 h + 1) / 3)).
std::size_t side_of_speed(std::span<const double> time_s, double fastest_m_s, double noise_m) {
  const std::size_t count = time_s.size();
  if (count < 3) return 1;
  const double dt_s = (time_s[count - 1] - time_s[0]) / static_cast<double>(count - 1);
  std::size_t side = 1;
  for (; static_cast<double>(side) * dt_s < kMostSide_s; ++side) {
    const auto h = static_cast<double>(side);
    const double doubt_m_s = noise_m / (dt_s * std::sqrt(h * (h + 1) * (2 * h + 1) / 3));
    if (doubt_m_s <= kSpeedDoubt * fastest_m_s) break;
  }
  return side;
}

/// A straight line through samples [first, last].
struct Line {
  double slope = 0;
  double spread_s2 = 0;  // of the times: a slope's variance is that of the noise over this
  double squares = 0;    // that it leaves
};

Line fit_line(std::span<const double> time_s, std::span<const double> values, std::size_t first,
              std::size_t last) {
  const auto count = static_cast<double>(last - first + 1);
  double mean_s = 0, mean = 0;
  for (std::size_t i = first; i <= last; ++i)
    mean_s += time_s[i] / count, mean += values[i] / count;
  double across = 0;
  Line line;
  for (std::size_t i = first; i <= last; ++i) {
    line.spread_s2 += (time_s[i] - mean_s) * (time_s[i] - mean_s);
    across += (time_s[i] - mean_s) * (values[i] - mean);
  }
  if (line.spread_s2 > 0) line.slope = across / line.spread_s2;
  for (std::size_t i = first; i <= last; ++i) {
    line.squares += std::pow(values[i] - mean - line.slope * (time_s[i] - mean_s), 2);
  }
  return line;
}

/// Slope at a sample, of the shortest line about it that tells it well and leaves no more than the
/// noise: a steady speed does not tremble, and what is not steady is not cut.
/// @param side samples on each side where no line does  @param enough_s2 spread of the times that
///        tells it well
double steady_slope(std::span<const double> time_s, std::span<const double> values, std::size_t at,
                    std::size_t side, double noise, double enough_s2) {
  const std::size_t count = values.size();
  Line best = fit_line(time_s, values, at - std::min(at, side), std::min(at + side, count - 1));
  const double sample_s =
      (time_s[count - 1] - time_s[0]) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
  for (std::size_t h = 1; static_cast<double>(h) * sample_s < kMostSteadySide_s; h += 1 + h / 8) {
    if (best.spread_s2 >= enough_s2 || h > at || at + h >= count) break;
    const Line line = fit_line(time_s, values, at - h, at + h);
    const double freedom = 2 * static_cast<double>(h) - 1;
    const double straight = noise * noise * (freedom + kStraight * std::sqrt(2 * freedom));
    if (line.squares < straight && line.spread_s2 > best.spread_s2) best = line;
  }
  return best.slope;
}

}  // namespace

sim::PressPath press_path(std::span<const double> time_s, std::span<const double> height_m) {
  sim::PressPath path;
  const std::vector<double> heights = bridged(time_s, height_m);
  const std::size_t count = heights.size();
  const double noise_m = estimate_noise(time_s, height_m);
  const double fastest_m_s = fastest(time_s, heights);
  const std::size_t side = side_of_speed(time_s, fastest_m_s, noise_m);
  const double enough_s2 = std::pow(noise_m / std::max(kSteadyDoubt * fastest_m_s, 1e-12), 2);
  const auto first = [](std::size_t i, std::size_t samples) { return i - std::min(i, samples); };
  const auto last = [&](std::size_t i, std::size_t samples) {
    return std::min(i + samples, count - 1);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double smooth_m =
        fit_polynomial(time_s, heights, i, first(i, kSideSamples), last(i, kSideSamples), 2).value;
    // Beyond its noise a height is right, and the parabola cuts a corner of the path.
    const bool within = std::abs(smooth_m - heights[i]) <= kNoises * noise_m;
    path.time_s.push_back(time_s[i] - time_s[0]);
    path.height_m.push_back(within ? smooth_m : heights[i]);
    path.speed_m_s.push_back(-steady_slope(time_s, heights, i, side, noise_m, enough_s2));
  }
  path.press.assign(count, 0);
  return path;
}

int count_presses(sim::PressPath& path, double surface_height_m, int before) {
  double deepest_m = 0;
  for (const double height_m : path.height_m) {
    deepest_m = std::max(deepest_m, surface_height_m - height_m);
  }
  // A plate that hovers at the surface makes no press.
  const double counted_m = 0.1 * deepest_m;
  int press = before;
  bool pressed = false;  // deep enough since the plate was last out of the sand
  for (std::size_t i = 0; i < path.height_m.size(); ++i) {
    const double depth_m = surface_height_m - path.height_m[i];
    if (pressed && depth_m <= 0) {
      ++press;
      pressed = false;
    }
    if (deepest_m > 0 && depth_m > counted_m) pressed = true;
    path.press[i] = press;
  }
  return pressed ? press + 1 : press;
}

std::vector<bool> on_block(std::span<const double> time_s, std::span<const double> height_m,
                           std::span<const double> force_N) {
  double largest_N = 0;
  for (const double force : force_N) {
    if (force > largest_N) largest_N = force;
  }
  constexpr double kBearing = 0.02;             // share of the largest force
  double low_m = INFINITY, high_m = -INFINITY;  // between which the plate bears
  for (std::size_t i = 0; i < force_N.size(); ++i) {
    if (!(force_N[i] > kBearing * largest_N) || std::isnan(height_m[i])) continue;
    low_m = std::min(low_m, height_m[i]);
    high_m = std::max(high_m, height_m[i]);
  }
  // Contact itself is a little higher, by noise and by what the rig travels first.
  const double noise_m = estimate_noise(time_s, height_m);
  const double aloft_m = high_m + 0.1 * (high_m - low_m) + 4 * noise_m;
  std::vector<bool> bears(force_N.size());
  for (std::size_t i = 0; i < force_N.size(); ++i) {
    const bool aloft = !(force_N[i] > kBearing * largest_N) && height_m[i] > aloft_m;
    bears[i] = !std::isnan(height_m[i]) && !std::isnan(force_N[i]) && !aloft;
  }
  return bears;
}

}  // namespace hoof::tools
