#include "tools/diagnose/series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hoof::tools {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kMedianOfNormal = 0.6745;  // of the size of a standard normal deviate
/// A sensor that gives each value three times or more has a step that is seen.
constexpr std::size_t kLeastRepeats = 3;
constexpr double kRounding = 1e-9;  // of the range: values nearer than that are one value

}  // namespace

Series valid_of(const Series& values) {
  Series valid;
  std::copy_if(values.begin(), values.end(), std::back_inserter(valid),
               [](double v) { return !std::isnan(v); });
  return valid;
}

double quantile(const Series& values, double share) {
  Series valid = valid_of(values);
  if (valid.empty()) return kNan;
  const auto at = valid.begin() + std::ptrdiff_t(share * double(valid.size() - 1) + 0.5);
  std::nth_element(valid.begin(), at, valid.end());
  return *at;
}

double median(const Series& values) {
  return quantile(values, 0.5);
}

double range_of(const Series& values) {
  const Series valid = valid_of(values);
  if (valid.empty()) return 0;
  const auto [low, high] = std::minmax_element(valid.begin(), valid.end());
  return *high - *low;
}

double deviation(const Series& values) {
  const Series valid = valid_of(values);
  if (valid.size() < 2) return 0;
  double mean = 0, squares = 0;
  for (const double v : valid) mean += v / double(valid.size());
  for (const double v : valid) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / double(valid.size()));
}

double quantum_of(const Series& values) {
  Series sorted = valid_of(values);
  if (sorted.size() < kLeastRepeats) return 0;
  std::sort(sorted.begin(), sorted.end());
  const double least = kRounding * (sorted.back() - sorted.front());
  double quantum = 0;
  std::size_t distinct = 1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double gap = sorted[i] - sorted[i - 1];
    if (gap <= least) continue;
    ++distinct;
    if (quantum == 0 || gap < quantum) quantum = gap;
  }
  return distinct * kLeastRepeats <= sorted.size() ? quantum : 0;
}

double noise_of(const Series& values) {
  Series sizes;
  for (std::size_t i = 3; i < values.size(); ++i) {
    const double third = values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3];
    if (!std::isnan(third)) sizes.push_back(std::abs(third));
  }
  const double rounding = quantum_of(values) / std::sqrt(12.0);
  if (sizes.empty()) return rounding;
  return std::max(rounding, median(sizes) / (kMedianOfNormal * std::sqrt(20.0)));
}

Series derivative(const Series& time_s, const Series& values, double half_window_s) {
  constexpr std::size_t kLeastEachSide = 2;
  constexpr int kLeastValid = 3;
  const std::size_t n = values.size();
  Series slopes(n, kNan);
  for (std::size_t i = kLeastEachSide; i + kLeastEachSide < n; ++i) {
    std::size_t first = i - kLeastEachSide, last = i + kLeastEachSide;
    while (first > 0 && time_s[i] - time_s[first - 1] <= half_window_s) --first;
    while (last + 1 < n && time_s[last + 1] - time_s[i] <= half_window_s) ++last;
    double t = 0, x = 0, tt = 0, tx = 0;
    int count = 0;
    for (std::size_t j = first; j <= last; ++j) {
      if (std::isnan(values[j])) continue;
      const double dt = time_s[j] - time_s[i];
      t += dt, x += values[j], tt += dt * dt, tx += dt * values[j];
      ++count;
    }
    const double determinant = count * tt - t * t;
    if (count >= kLeastValid && determinant > 0) slopes[i] = (count * tx - t * x) / determinant;
  }
  return slopes;
}

Relation relate_shifted(const Series& a, const Series& b, int shift) {
  const auto size = std::ptrdiff_t(std::min(a.size(), b.size()));
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  Relation relation;
  // About the first pair, so that large offsets do not eat the digits.
  double a0 = kNan, b0 = kNan;
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    if (i + shift < 0 || i + shift >= size) continue;
    const double x = a[std::size_t(i + shift)], y = b[std::size_t(i)];
    if (std::isnan(x) || std::isnan(y)) continue;
    if (relation.count == 0) a0 = x, b0 = y;
    const double da = x - a0, db = y - b0;
    sa += da, sb += db, saa += da * da, sbb += db * db, sab += da * db;
    ++relation.count;
  }
  if (relation.count < 3) return relation;
  const double n = relation.count;
  const double va = saa / n - sa * sa / n / n, vb = sbb / n - sb * sb / n / n;
  const double cov = sab / n - sa * sb / n / n;
  if (!(va > 0) || !(vb > 0)) return relation;
  relation.r = cov / std::sqrt(va * vb);
  relation.ratio = std::copysign(std::sqrt(va / vb), cov);
  return relation;
}

Relation relate(const Series& a, const Series& b) {
  return relate_shifted(a, b, 0);
}

}  // namespace hoof::tools
