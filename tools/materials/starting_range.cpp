#include "tools/materials/starting_range.h"

#include <algorithm>
#include <cmath>

#include "tools/calibrate/lab_rules.h"

namespace hoof::tools {
namespace {

constexpr double kUsualDoubt = 0.05;
constexpr double kSlice = 0.1;        // of the box's half: what counts as the same value
constexpr double kDifference = 1e-4;  // coded, of a derivative
constexpr int kSteps = 40;

/// Moves a point onto the target along the factor that changes the angle most, within the box.
void polish(const ResponseSurface& surface, double target_deg, std::vector<double>& point) {
  for (int i = 0; i < kSteps; ++i) {
    const double left = target_deg - surface.at(point);
    std::size_t best = point.size();
    double slope = 0;
    for (std::size_t f = 0; f < point.size(); ++f) {
      std::vector<double> beside = point;
      beside[f] += kDifference;
      const double s = (surface.at(beside) - surface.at(point)) / kDifference;
      const double moved = point[f] + left / s;
      if (std::abs(s) > std::abs(slope) && moved >= -1 && moved <= 1) best = f, slope = s;
    }
    if (best == point.size()) return;
    point[best] += left / slope;
  }
}

std::size_t longest(const Valley& valley, const std::vector<Factor>& factors) {
  const auto span = [&](std::size_t f) {
    return (valley.high[f] - valley.low[f]) / factors[f].half();
  };
  std::size_t best = 0;
  for (std::size_t f = 1; f < factors.size(); ++f) {
    if (span(f) > span(best)) best = f;
  }
  return best;
}

/// The point of the valley nearest to the middle of its slice at `at` of factor `along`.
std::vector<double> middle_of_slice(const Valley& valley, std::size_t along, double at) {
  std::vector<double> mean(valley.points.front().size(), 0.0);
  double n = 0;
  for (const auto& p : valley.points) {
    if (std::abs(p[along] - at) > kSlice) continue;
    for (std::size_t f = 0; f < p.size(); ++f) mean[f] += p[f];
    n += 1;
  }
  for (std::size_t f = 0; f < mean.size(); ++f) mean[f] = n > 0 ? mean[f] / n : 0;
  mean[along] = at;
  const auto distance = [&mean](const std::vector<double>& p) {
    double sum = 0;
    for (std::size_t f = 0; f < p.size(); ++f) sum += (p[f] - mean[f]) * (p[f] - mean[f]);
    return sum;
  };
  return *std::min_element(valley.points.begin(), valley.points.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
}

}  // namespace

void StartingRequest::validate() const {
  require_within("bulk-density", bulk_density_kg_m3, 300, 5000, "kg/m3");
  require_within("repose", repose_deg, 1, 89, "deg");
  require_within("tolerance", tolerance_deg, 0.05, 10, "deg");
  if (d50_m) require_within("d50", 1e3 * *d50_m, 0.001, 100, "mm");
}

std::vector<double> usual_doubts(const ReposeSurface& surface) {
  std::vector<double> doubts;
  for (const Factor& f : surface.surface.factors()) {
    doubts.push_back(kUsualDoubt * (f.high - f.low));
  }
  return doubts;
}

StartingRange starting_range(const ReposeSurface& s, const StartingRequest& request,
                             const std::vector<double>& doubts) {
  StartingRange out;
  out.covered = request.repose_deg >= s.lowest_deg && request.repose_deg <= s.highest_deg;
  out.valley = find_valley(s.surface, request.repose_deg, request.tolerance_deg, doubts);
  if (out.valley.points.empty()) return out;
  const std::vector<Factor>& factors = s.surface.factors();
  const std::size_t along = longest(out.valley, factors);
  const double low = factors[along].coded(out.valley.low[along]);
  const double high = factors[along].coded(out.valley.high[along]);
  for (const double share : {0.5, 0.1, 0.9}) {
    StartingRange::Member m;
    m.coded = middle_of_slice(out.valley, along, low + share * (high - low));
    polish(s.surface, request.repose_deg, m.coded);
    m.restitution = factors[0].value(m.coded[0]);
    m.rolling_friction = factors[1].value(m.coded[1]);
    m.static_friction = factors[2].value(m.coded[2]);
    m.angle_deg = s.surface.at(m.coded);
    m.half95_deg = s.surface.mean_half95(m.coded);
    out.members.push_back(m);
  }
  return out;
}

}  // namespace hoof::tools
