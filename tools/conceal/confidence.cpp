#include "tools/conceal/confidence.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace hoof::tools::conceal {
namespace {

constexpr double kTail = 0.025;

}  // namespace

Bounds clopper_pearson(int good, int count) {
  if (count == 0) return {};
  using Binomial = boost::math::binomial_distribution<>;
  return {good == 0 ? 0.0 : Binomial::find_lower_bound_on_p(count, good, kTail),
          good == count ? 1.0 : Binomial::find_upper_bound_on_p(count, good, kTail)};
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

Bounds mean_bounds(const std::vector<double>& values) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (values.size() < 2) return {-kInfinity, kInfinity};
  const double mean = mean_of(values), n = double(values.size());
  double square = 0.0;
  for (const double v : values) square += (v - mean) * (v - mean);
  const boost::math::students_t student(n - 1.0);
  const double reach = boost::math::quantile(boost::math::complement(student, kTail)) *
                       std::sqrt(square / (n - 1.0) / n);
  return {mean - reach, mean + reach};
}

}  // namespace hoof::tools::conceal
