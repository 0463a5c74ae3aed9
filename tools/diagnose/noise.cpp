#include "tools/diagnose/noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace hoof::tools {
namespace {

constexpr int kWindow = 7;
constexpr double kMadToSigma = 1.4826;  // of a normal distribution

/// What a cubic through the window leaves at its middle, scaled to the noise of one sample.
double middle_residual(const double* time_s, const double* values) {
  Eigen::Matrix<double, kWindow, 4> A;
  Eigen::Matrix<double, kWindow, 1> y;
  const double middle = time_s[kWindow / 2];
  const double scale = time_s[kWindow - 1] - time_s[0];
  for (int i = 0; i < kWindow; ++i) {
    const double x = 2 * (time_s[i] - middle) / scale;
    A.row(i) << 1, x, x * x, x * x * x;
    y[i] = values[i];
  }
  const Eigen::Matrix4d inverse = (A.transpose() * A).inverse();
  const Eigen::Vector4d fit = inverse * (A.transpose() * y);
  const Eigen::Vector4d row = A.row(kWindow / 2).transpose();
  const double leverage = row.dot(inverse * row);
  return (values[kWindow / 2] - row.dot(fit)) / std::sqrt(std::max(1 - leverage, 0.05));
}

}  // namespace

double resolution(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double v : values) {
    if (std::isfinite(v)) sorted.push_back(v);
  }
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() < 8) return 0;
  const double range = sorted.back() - sorted.front();
  double step = 0;
  std::size_t levels = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double d = sorted[i] - sorted[i - 1];
    if (d <= 1e-9 * range) continue;
    ++levels;
    step = step == 0 ? d : std::min(step, d);
  }
  // Where hardly a value comes twice there is no resolution to be seen.
  return levels * 2 < sorted.size() ? step : 0;
}

double estimate_noise(std::span<const double> time_s, std::span<const double> values) {
  std::vector<double> residuals;
  for (std::size_t i = 0; i + kWindow <= values.size(); ++i) {
    const double r = middle_residual(&time_s[i], &values[i]);
    if (std::isfinite(r)) residuals.push_back(std::abs(r));
  }
  if (residuals.size() < 10) return 0;
  const auto middle = residuals.begin() + static_cast<long>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return std::max(kMadToSigma * *middle, resolution(values) / std::sqrt(12.0));
}

double first_slope(std::span<const double> time_s, std::span<const double> values, double span_s) {
  double n = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = time_s[i] - time_s[0];
    if (n >= 3 && x > span_s) break;
    if (!std::isfinite(values[i])) continue;
    n += 1, t += x, y += values[i], tt += x * x, ty += x * values[i];
  }
  const double spread = n * tt - t * t;
  return spread > 0 ? (n * ty - t * y) / spread : 0;
}

std::vector<double> slopes(std::span<const double> time_s, std::span<const double> values,
                           double span_s) {
  std::vector<double> all(values.size());
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (time_s[from] < time_s[i] - span_s) ++from;
    while (to < values.size() && time_s[to] <= time_s[i] + span_s) ++to;
    double n = 0, t = 0, y = 0, tt = 0, ty = 0;
    for (std::size_t k = from; k < to; ++k) {
      if (!std::isfinite(values[k])) continue;
      const double x = time_s[k] - time_s[i];
      n += 1, t += x, y += values[k], tt += x * x, ty += x * values[k];
    }
    const double spread = n * tt - t * t;
    all[i] = spread > 0 ? (n * ty - t * y) / spread : std::nan("");
  }
  return all;
}

std::vector<double> without_noise(std::span<const double> time_s, std::span<const double> values,
                                  std::size_t span) {
  constexpr double kMostLeft = 1.5;  // times the noise: a corner or a step lies in the span
  std::vector<double> smooth(values.begin(), values.end());
  const double noise = estimate_noise(time_s, values);
  if (!(noise > 0) || span < 5) return smooth;
  const auto rows = static_cast<Eigen::Index>(span);
  Eigen::MatrixXd A(rows, 3);
  Eigen::VectorXd y(rows);
  for (std::size_t i = 0; i + span <= values.size(); ++i) {
    const std::size_t middle = i + span / 2;
    const double scale = time_s[i + span - 1] - time_s[i];
    for (std::size_t k = 0; k < span; ++k) {
      const double x = 2 * (time_s[i + k] - time_s[middle]) / scale;
      A.row(static_cast<Eigen::Index>(k)) << 1, x, x * x;
      y[static_cast<Eigen::Index>(k)] = values[i + k];
    }
    const Eigen::Vector3d fit = (A.transpose() * A).ldlt().solve(A.transpose() * y);
    const double left = (y - A * fit).norm() / std::sqrt(static_cast<double>(span) - 3.0);
    if (left < kMostLeft * noise) smooth[middle] = fit[0];
  }
  return smooth;
}

double rms(std::span<const double> values) {
  double sum = 0, n = 0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v * v, n += 1;
  }
  return n > 0 ? std::sqrt(sum / n) : 0;
}

}  // namespace hoof::tools
