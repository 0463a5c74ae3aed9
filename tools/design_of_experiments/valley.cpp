#include "tools/design_of_experiments/valley.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

/// Points for which the rest of the valley is looked at, evenly over it.
constexpr std::size_t kLooked = 400;

Valley::Left left_by(const Valley& valley, const std::vector<Factor>& factors, std::size_t known,
                     double doubt) {
  const std::size_t count = factors.size();
  Valley::Left left{doubt, 0, std::vector<double>(count, 0.0)};
  const double coded = doubt / factors[known].half();
  const std::size_t stride = std::max<std::size_t>(1, valley.points.size() / kLooked);
  double looked = 0;
  for (std::size_t i = 0; i < valley.points.size(); i += stride) {
    double stays = 0;
    std::vector<double> low(count, 1), high(count, -1);
    for (const auto& point : valley.points) {
      if (std::abs(point[known] - valley.points[i][known]) > coded + 1e-9) continue;
      stays += 1;
      for (std::size_t f = 0; f < count; ++f) {
        low[f] = std::min(low[f], point[f]);
        high[f] = std::max(high[f], point[f]);
      }
    }
    left.share += stays / static_cast<double>(valley.points.size());
    for (std::size_t f = 0; f < count; ++f) {
      const double whole = (valley.high[f] - valley.low[f]) / factors[f].half();
      left.width[f] += whole > 0 ? (high[f] - low[f]) / whole : 0;
    }
    looked += 1;
  }
  left.share /= looked;
  for (double& width : left.width) width /= looked;
  return left;
}

}  // namespace

int Valley::most_telling() const {
  if (left.empty()) return -1;
  const auto least = std::min_element(
      left.begin(), left.end(), [](const Left& a, const Left& b) { return a.share < b.share; });
  return static_cast<int>(least - left.begin());
}

Valley find_valley(const ResponseSurface& surface, double target, double tolerance,
                   const std::vector<double>& doubts, int steps) {
  const std::vector<Factor>& factors = surface.factors();
  const std::size_t count = factors.size();
  Valley valley;
  std::size_t all = 1;
  for (std::size_t f = 0; f < count; ++f) all *= static_cast<std::size_t>(steps);
  std::vector<double> point(count);
  for (std::size_t i = 0; i < all; ++i) {
    std::size_t rest = i;
    for (std::size_t f = 0; f < count; ++f) {
      point[f] =
          -1 + 2.0 * static_cast<double>(rest % static_cast<std::size_t>(steps)) / (steps - 1);
      rest /= static_cast<std::size_t>(steps);
    }
    if (std::abs(surface.at(point) - target) <= tolerance) valley.points.push_back(point);
  }
  valley.share = static_cast<double>(valley.points.size()) / static_cast<double>(all);
  if (valley.points.empty()) return valley;
  for (std::size_t f = 0; f < count; ++f) {
    const auto less = [f](const auto& a, const auto& b) { return a[f] < b[f]; };
    const auto [low, high] = std::minmax_element(valley.points.begin(), valley.points.end(), less);
    valley.low.push_back(factors[f].value((*low)[f]));
    valley.high.push_back(factors[f].value((*high)[f]));
  }
  for (std::size_t f = 0; f < count; ++f) {
    valley.left.push_back(left_by(valley, factors, f, doubts[f]));
  }
  return valley;
}

}  // namespace hoof::tools
