#include "tools/calibrate/heap_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tools/study/statistics.h"

namespace hoof::tools {
namespace {

constexpr double kGrid_m = 1e-3;
constexpr double kRing_m = 2e-3;                // width, of the means that tell the radius
constexpr double kInner = 0.25, kOuter = 0.85;  // of the heap's radius
constexpr int kSides = 18, kEighths = 8;

/// Least squares of z over r, as the angle of the fall.
class Slope {
 public:
  void add(double r, double z) { n_ += 1, r_ += r, z_ += z, rr_ += r * r, rz_ += r * z; }
  double angle_deg() const {
    const double slope = (n_ * rz_ - r_ * z_) / (n_ * rr_ - r_ * r_);
    return std::atan(-slope) * 180 / std::numbers::pi;
  }

 private:
  double n_ = 0, r_ = 0, z_ = 0, rr_ = 0, rz_ = 0;
};

/// Heights over a square grid about the origin; 0, the floor, where no grain lies.
class Surface {
 public:
  explicit Surface(double radius_m)
      : half_(int(std::ceil(radius_m / kGrid_m))), z_m_(std::size_t(width() * width()), 0.0) {}

  void cover(const sim::Grain& g) {
    const auto low = [&](double x) { return int(std::floor((x - g.radius_m) / kGrid_m)); };
    const auto high = [&](double x) { return int(std::ceil((x + g.radius_m) / kGrid_m)); };
    for (int i = std::max(-half_, low(g.p_m.x())); i <= std::min(half_, high(g.p_m.x())); ++i) {
      for (int j = std::max(-half_, low(g.p_m.y())); j <= std::min(half_, high(g.p_m.y())); ++j) {
        const double dx = i * kGrid_m - g.p_m.x(), dy = j * kGrid_m - g.p_m.y();
        const double cap2 = g.radius_m * g.radius_m - dx * dx - dy * dy;
        if (cap2 > 0) z_m(i, j) = std::max(z_m(i, j), g.p_m.z() + std::sqrt(cap2));
      }
    }
  }

  template <typename Visit>  // (x, y, z) of each point, m
  void visit(const Visit& point) const {
    for (int i = -half_; i <= half_; ++i) {
      for (int j = -half_; j <= half_; ++j) {
        point(i * kGrid_m, j * kGrid_m, z_m_[index(i, j)]);
      }
    }
  }

 private:
  int width() const { return 2 * half_ + 1; }
  std::size_t index(int i, int j) const { return std::size_t((i + half_) * width() + j + half_); }
  double& z_m(int i, int j) { return z_m_[index(i, j)]; }

  int half_;
  std::vector<double> z_m_;
};

/// Mean over both flanks, seen along the direction at `azimuth`.
double outline_deg(const Surface& surface, double radius_m, double azimuth) {
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const int n = int(std::ceil(radius_m / kGrid_m));
  std::vector<double> top_m(std::size_t(2 * n + 1), 0.0);
  surface.visit([&](double x, double y, double z) {
    if (x * x + y * y > radius_m * radius_m) return;
    const int k = int(std::lround((x * c + y * s) / kGrid_m));
    double& top = top_m[std::size_t(std::clamp(k, -n, n) + n)];
    top = std::max(top, z);
  });
  std::array<Slope, 2> flanks;
  for (int k = -n; k <= n; ++k) {
    const double u = std::abs(k) * kGrid_m / radius_m;
    if (u >= kInner && u <= kOuter) {
      flanks[k < 0 ? 0 : 1].add(std::abs(k) * kGrid_m, top_m[std::size_t(k + n)]);
    }
  }
  return 0.5 * (flanks[0].angle_deg() + flanks[1].angle_deg());
}

}  // namespace

double heap_radius_m(const std::vector<sim::Grain>& grains, double floor_m) {
  double reach_m = 0;
  for (const sim::Grain& g : grains) {
    if (g.p_m.z() >= 0) reach_m = std::max(reach_m, g.p_m.head<2>().norm() + g.radius_m);
  }
  Surface surface(reach_m);
  for (const sim::Grain& g : grains) {
    if (g.p_m.z() >= 0) surface.cover(g);
  }
  std::vector<double> sum_m(std::size_t(std::ceil(reach_m / kRing_m)) + 1, 0.0), n(sum_m.size());
  surface.visit([&](double x, double y, double z) {
    const auto ring = std::size_t(std::hypot(x, y) / kRing_m);
    if (ring < sum_m.size()) sum_m[ring] += z, n[ring] += 1;
  });
  std::size_t ring = 0;
  while (ring < n.size() && n[ring] > 0 && sum_m[ring] >= floor_m * n[ring]) ++ring;
  if (ring == 0) throw std::invalid_argument("there is no heap about the axis");
  return double(ring) * kRing_m;
}

HeapAngle heap_angle(const std::vector<sim::Grain>& grains, double radius_m) {
  if (!(radius_m >= 5 * kGrid_m)) {
    throw std::invalid_argument("a heap needs a radius of at least 5 mm");
  }
  HeapAngle out;
  out.radius_m = radius_m;
  Surface surface(radius_m);
  for (const sim::Grain& g : grains) {
    if (g.p_m.z() < 0 || g.p_m.head<2>().norm() > radius_m) continue;
    ++out.grains_in_it;
    surface.cover(g);
  }
  if (out.grains_in_it == 0) throw std::invalid_argument("no grain lies within the heap's radius");
  Slope ring;
  std::array<Slope, kEighths> eighths;
  surface.visit([&](double x, double y, double z) {
    out.height_m = std::max(out.height_m, z);
    const double r = std::hypot(x, y);
    if (r < kInner * radius_m || r > kOuter * radius_m) return;
    ring.add(r, z);
    const double turn = (std::atan2(y, x) / std::numbers::pi + 1) / 2;  // 0..1
    eighths[std::size_t(turn * kEighths) % kEighths].add(r, z);
  });
  out.ring_deg = ring.angle_deg();
  std::vector<double> parts;
  for (const Slope& part : eighths) parts.push_back(part.angle_deg());
  out.sides_deg = sample_of(parts).deviation;
  for (int side = 0; side < kSides; ++side) {
    out.outline_deg += outline_deg(surface, radius_m, std::numbers::pi * side / kSides) / kSides;
  }
  return out;
}

}  // namespace hoof::tools
