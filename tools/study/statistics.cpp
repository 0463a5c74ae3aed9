#include "tools/study/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hoof::tools {
namespace {

/// From 1 on; equal values share their mean.
std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<double> out;
  for (const double v : values) {
    const auto below = std::count_if(values.begin(), values.end(), [v](double o) { return o < v; });
    const auto equal = std::count(values.begin(), values.end(), v);
    out.push_back(double(below) + 0.5 * double(equal + 1));
  }
  return out;
}

}  // namespace

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) throw std::invalid_argument("rank correlation of unequal lists");
  const std::vector<double> ra = ranks(a), rb = ranks(b);
  const double middle = 0.5 * double(a.size() + 1);  // the mean of any ranks
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (ra[i] - middle) * (rb[i] - middle);
    aa += (ra[i] - middle) * (ra[i] - middle);
    bb += (rb[i] - middle) * (rb[i] - middle);
  }
  return ab / std::sqrt(aa * bb);  // 0 / 0 where one is constant
}

double kendall_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) throw std::invalid_argument("rank correlation of unequal lists");
  const auto sign = [](double x) { return double(x > 0) - double(x < 0); };
  double both = 0, in_a = 0, in_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double da = sign(a[i] - a[j]), db = sign(b[i] - b[j]);
      both += da * db;
      in_a += da * da;
      in_b += db * db;
    }
  }
  return both / std::sqrt(in_a * in_b);  // 0 / 0 where one is constant
}

double student_t_975(std::size_t degrees) {
  // Student (1908), any table; 12.706 for one degree of freedom.
  constexpr std::array kT = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
  if (degrees == 0) return std::numeric_limits<double>::quiet_NaN();
  return kT[std::min(degrees, kT.size()) - 1];
}

Sample sample_of(const std::vector<double>& values) {
  Sample s;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    ++s.n;
    s.mean += v;
    if (v > 1) ++s.above_one;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (s.n == 0) return {0, nan, nan, nan, nan, 0};
  s.mean /= double(s.n);
  double squares = 0;
  for (const double v : values) {
    if (!std::isnan(v)) squares += (v - s.mean) * (v - s.mean);
  }
  s.deviation = s.n > 1 ? std::sqrt(squares / double(s.n - 1)) : nan;
  s.standard_error = s.deviation / std::sqrt(double(s.n));
  s.confidence = student_t_975(s.n - 1) * s.standard_error;
  return s;
}

}  // namespace hoof::tools
