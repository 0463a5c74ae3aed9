// Where a rollout begins: as measured, and better where the recording begins at rest.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/pendulum_model.h"

namespace hoof::tools {
namespace {

using sim::PendulumLaw;

constexpr double kStartSpan_s = 0.02;  // of the contract
/// At rest is what stays within this many standard deviations of its mean.
constexpr double kStill = 4;
constexpr std::size_t kFewest = 5;
/// A torque at its limit tells nothing of the angle.
constexpr double kFree = 0.95;

/// Mean of values with one known deviation, as it grows.
struct Mean {
  double sum = 0, count = 0;
  void add(double v) { sum += v, count += 1; }
  double value() const { return sum / count; }
};

/// Number of leading samples of a noisy constant.
std::size_t still_samples(std::span<const double> values, double noise) {
  Mean all;
  std::size_t n = 0;
  for (; n < values.size(); ++n) {
    if (!std::isfinite(values[n])) continue;
    if (all.count > 0) {
      const double doubt = noise * std::sqrt(1 + 1 / all.count);
      // A slow creep shows in the mean of the last few before it shows in one.
      Mean last;
      for (std::size_t i = n + 1 > kFewest ? n + 1 - kFewest : 0; i <= n; ++i) {
        if (std::isfinite(values[i])) last.add(values[i]);
      }
      const double far = noise * std::sqrt(1 / last.count + 1 / all.count);
      if (std::abs(values[n] - all.value()) > kStill * doubt) break;
      if (all.count > 2 * kFewest && std::abs(last.value() - all.value()) > kStill * far) break;
    }
    all.add(values[n]);
  }
  return n > kFewest ? n - kFewest : 0;
}

struct StartOfPath {
  double angle = 0, speed = 0;
  double speed_doubt = 0;  // 1 sigma; 0: no polynomial fits
};

/// A polynomial in time over its span, by least squares.
struct Polynomial {
  Eigen::VectorXd c, sigma;  // coefficients and their deviations for noise of 1
  double squares = 0;
  double freedom = 0;
};

Polynomial fit_polynomial(std::span<const double> time_s, std::span<const double> values,
                          double span_s, int order) {
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) there.push_back(i);
  }
  const auto rows = static_cast<Eigen::Index>(there.size());
  Polynomial p;
  p.freedom = static_cast<double>(rows - order - 1);
  if (p.freedom < 2) return p;
  Eigen::MatrixXd A(rows, order + 1);
  Eigen::VectorXd y(rows);
  for (Eigen::Index r = 0; r < rows; ++r) {
    const std::size_t i = there[static_cast<std::size_t>(r)];
    y[r] = values[i];
    for (int k = 0; k <= order; ++k) A(r, k) = std::pow((time_s[i] - time_s[0]) / span_s, k);
  }
  p.c = A.householderQr().solve(y);
  p.squares = (y - A * p.c).squaredNorm();
  p.sigma = (A.transpose() * A).inverse().diagonal().cwiseSqrt();
  return p;
}

/// What tells the speed best of polynomials that leave the noise only, and of which the next term
/// would be none.
StartOfPath start_of_path(std::span<const double> time_s, std::span<const double> values,
                          double noise) {
  constexpr std::array<std::size_t, 6> kSamples = {6, 9, 14, 20, 30, 45};
  constexpr double kNone = 1.3, kFits = 2;  // deviations; of a coefficient, of the sum of squares
  StartOfPath best;
  if (!(noise > 0)) return best;
  for (const std::size_t n : kSamples) {
    if (n > values.size()) break;
    const double span_s = time_s[n - 1] - time_s[0];
    Polynomial p = fit_polynomial(time_s.first(n), values.first(n), span_s, 1);
    for (int order = 1; order <= 3 && p.freedom >= 2; ++order) {
      Polynomial next = fit_polynomial(time_s.first(n), values.first(n), span_s, order + 1);
      const double chi2 = p.squares / (noise * noise) / p.freedom;
      const bool straight =
          next.freedom < 2 || std::abs(next.c[order + 1]) < kNone * noise * next.sigma[order + 1];
      const double doubt = noise * p.sigma[1] / span_s;
      const bool better = best.speed_doubt == 0 || doubt < best.speed_doubt;
      if (straight && better && chi2 < 1 + kFits * std::sqrt(2 / p.freedom)) {
        best = {p.c[0], p.c[1] / span_s, doubt};
      }
      p = std::move(next);
    }
  }
  return best;
}

}  // namespace

void PendulumModel::estimate_start(Run& run) const {
  const Recording& recording = *run.recording;
  const auto position = recording.values("position");
  const auto velocity = recording.values("velocity");
  const auto first =
      std::find_if(position.begin(), position.end(), [](double v) { return std::isfinite(v); });
  run.start.position_rad = first == position.end() ? 0 : *first;
  const bool measured = !velocity.empty() && std::isfinite(velocity.front());
  run.start.velocity_rad_s =
      measured ? velocity.front() : first_slope(recording.time_s, position, kStartSpan_s);
  run.fitted_start = run.start;
  start_in_motion(run);
  start_at_rest(run);
}

/// Angle and speed by the polynomial over the first samples that tells the speed best and leaves no
/// more than the noise. A speed from few samples is off by more than a loop forgets in its first
/// tenth of a second.
void PendulumModel::start_in_motion(Run& run) const {
  const Recording& recording = *run.recording;
  const auto position = recording.values("position");
  double noise = stated_noise(*run.data_set, "position");
  noise = std::max(noise, estimate_noise(recording.time_s, position));
  const bool measured = recording.has("velocity");
  const auto velocity = recording.values("velocity");
  double speed_doubt = 0;
  if (measured) {
    speed_doubt = std::max(stated_noise(*run.data_set, "velocity"),
                           estimate_noise(recording.time_s, velocity));
  }
  const StartOfPath path = start_of_path(recording.time_s, position, noise);
  if (!(path.speed_doubt > 0)) return;
  run.fitted_start.position_rad = path.angle;
  const double a = path.speed_doubt * path.speed_doubt, b = speed_doubt * speed_doubt;
  run.fitted_start.velocity_rad_s = measured && std::isfinite(velocity.front()) && b > 0
                                        ? (b * path.speed + a * velocity.front()) / (a + b)
                                        : path.speed;
  run.start_speed_doubt_rad_s = measured && b > 0 ? std::sqrt(a * b / (a + b)) : path.speed_doubt;
}

/// A joint that sticks keeps the angle it begins at: an error of one sample's noise there is an
/// offset of the torque of a stiff drive for as long. The mean over the time at rest, and what the
/// torque tells of the same angle, have less of it.
void PendulumModel::start_at_rest(Run& run) const {
  const Recording& recording = *run.recording;
  const auto position = recording.values("position");
  double noise = stated_noise(*run.data_set, "position");
  noise = std::max(noise, estimate_noise(recording.time_s, position));
  const std::size_t n = noise > 0 ? still_samples(position, noise) : 0;
  // A slow motion hides in the noise of a few samples, not in the path over more of them.
  const bool moves =
      std::abs(run.fitted_start.velocity_rad_s) > kStill * run.start_speed_doubt_rad_s;
  if (n < kFewest || (run.start_speed_doubt_rad_s > 0 && moves)) return;
  Mean angle;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isfinite(position[i])) angle.add(position[i]);
  }
  if (angle.count < kFewest) return;
  run.fitted_start.velocity_rad_s = 0;
  run.start_speed_doubt_rad_s = 0;
  run.fitted_start.position_rad = angle.value();
  const auto torque = recording.values("torque");
  const auto goal = recording.values("position_goal");
  const sim::PendulumSettings& s = run.settings;
  const bool exact = run.doubts.count("kp") == 0 && run.doubts.count("kd") == 0;
  if (s.law != PendulumLaw::kImpedance || torque.empty() || !exact || s.kp_Nm_rad <= 0) return;
  const auto velocity_goal = recording.values("velocity_goal");
  const auto feed_forward = recording.values("torque_ff");
  const auto enable = recording.values("enable");
  Mean by_torque;
  for (std::size_t i = 0; i < n; ++i) {
    const bool off = !enable.empty() && enable[i] < 0.5;
    if (!std::isfinite(torque[i]) || off) continue;
    if (std::abs(torque[i]) > kFree * s.torque_limit_Nm) continue;
    const double wanted = (velocity_goal.empty() ? 0 : s.kd_Nm_s_rad * velocity_goal[i]) +
                          (feed_forward.empty() ? 0 : feed_forward[i]);
    by_torque.add(goal[i] - (torque[i] - wanted) / s.kp_Nm_rad);
  }
  if (by_torque.count < kFewest) return;
  const double torque_noise =
      std::max(stated_noise(*run.data_set, "torque"), estimate_noise(recording.time_s, torque));
  const double a = noise * noise / angle.count;
  const double b = std::pow(torque_noise / s.kp_Nm_rad, 2) / by_torque.count;
  // An encoder may be off by more than its noise; then the angle it reads is what the drive sees.
  if (std::abs(by_torque.value() - angle.value()) > kStill * std::sqrt(a + b)) return;
  if (a + b > 0) {
    run.fitted_start.position_rad = (b * angle.value() + a * by_torque.value()) / (a + b);
  }
}

}  // namespace hoof::tools
