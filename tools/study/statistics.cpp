#include "tools/study/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hoof::tools {

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
