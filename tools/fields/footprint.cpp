#include "tools/fields/footprint.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {

Footprint::Footprint(const PlacedFoot& foot, const Eigen::AlignedBox3d& region_m)
    : low_m_(region_m.min().head<2>()),
      columns_(std::max(1, int(std::ceil(region_m.sizes().x() / kCell_m)))),
      rows_(std::max(1, int(std::ceil(region_m.sizes().y() / kCell_m)))),
      cells_(std::size_t(columns_) * std::size_t(rows_), kNone) {
  for (const FootTriangle& t : foot.triangles) {
    if (t.part != FootPart::kSpine) cover(t);
  }
  find_gaps();
  const double cell_m2 = kCell_m * kCell_m;
  for (const std::uint8_t c : cells_) {
    if (c == kGap) gap_area_m2_ += cell_m2;
    if (c < kGap) foot_area_m2_ += cell_m2;
  }
}

/// The cells whose middles lie under the triangle.
void Footprint::cover(const FootTriangle& t) {
  Eigen::Vector2d p[3];
  Eigen::AlignedBox2d box;
  for (int k = 0; k < 3; ++k) {
    p[k] = (t.corners_m[k].head<2>() - low_m_) / kCell_m - Eigen::Vector2d::Constant(0.5);
    box.extend(p[k]);
  }
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const double area = cross(p[1] - p[0], p[2] - p[0]);
  if (area == 0) return;
  constexpr double kEdge = -1e-9;  // on an edge counts for both sides
  for (int j = std::max(0, int(std::ceil(box.min().y())));
       j <= std::min(rows_ - 1, int(std::floor(box.max().y()))); ++j) {
    for (int i = std::max(0, int(std::ceil(box.min().x())));
         i <= std::min(columns_ - 1, int(std::floor(box.max().x()))); ++i) {
      const Eigen::Vector2d q(i, j);
      bool inside = true;
      for (int k = 0; k < 3; ++k) {
        inside &= cross(p[(k + 1) % 3] - p[k], q - p[k]) / area >= kEdge;
      }
      if (inside)
        cells_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)] = std::uint8_t(t.body);
    }
  }
}

void Footprint::find_gaps() {
  const int narrowest = int(std::lround(kNarrowest_m / kCell_m));
  for (int i = 0; i < columns_; ++i) {
    int last = -1;  // row of the last cell under the foot
    for (int j = 0; j < rows_; ++j) {
      const auto cell = [&](int row) -> std::uint8_t& {
        return cells_[std::size_t(row) * std::size_t(columns_) + std::size_t(i)];
      };
      if (cell(j) >= kGap) continue;
      if (last >= 0 && cell(last) != cell(j) && j - last - 1 >= narrowest) {
        for (int k = last + 1; k < j; ++k) cell(k) = kGap;
      }
      last = j;
    }
  }
}

std::uint8_t Footprint::at(double x_m, double y_m) const {
  const double i = std::floor((x_m - low_m_.x()) / kCell_m);
  const double j = std::floor((y_m - low_m_.y()) / kCell_m);
  if (!(i >= 0 && j >= 0 && i < columns_ && j < rows_)) return kNone;
  return cells_[std::size_t(j) * std::size_t(columns_) + std::size_t(i)];
}

}  // namespace hoof::tools
