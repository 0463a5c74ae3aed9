#include "tools/diagnose/series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/noise.h"

namespace hoof::tools {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

Series derivative(const Series& time_s, const Series& values, double half_window_s) {
  constexpr double kLeastSteps = 2.01;
  Series steps;
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return slopes(time_s, values, std::max(half_window_s, kLeastSteps * median(steps)));
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
