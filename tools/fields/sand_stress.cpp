#include "tools/fields/sand_stress.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools {
namespace {

/// Share of the line from a to b that lies in the box: the slabs of its three pairs of sides.
double share_in(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                const Eigen::AlignedBox3d& box) {
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = b[axis] - a[axis];
    double enters = box.min()[axis] - a[axis], leaves = box.max()[axis] - a[axis];
    if (way == 0) {
      // A line along a side belongs to the box above it alone.
      if (enters > 0 || leaves <= 0) return 0;
      continue;
    }
    enters /= way, leaves /= way;
    if (enters > leaves) std::swap(enters, leaves);
    first = std::max(first, enters), last = std::min(last, leaves);
  }
  return std::max(0.0, last - first);
}

/// Cells of size `cell` along one axis that a line from a to b may meet.
struct Span {
  int first, last;
};
Span span(double a, double b, double low, double cell, int count) {
  return {std::max(0, int(std::floor((std::min(a, b) - low) / cell))),
          std::min(count - 1, int(std::floor((std::max(a, b) - low) / cell)))};
}

/// Vertical stress of the cells of one layer, row after row along y.
std::vector<double> layer_zz_Pa(const std::vector<ForceLine>& lines,
                                const Eigen::AlignedBox3d& layer_m, double cell_m, int columns,
                                int rows) {
  std::vector<double> zz_Pa(std::size_t(columns) * std::size_t(rows));
  const Eigen::Vector3d low = layer_m.min();
  const double volume_m3 = cell_m * cell_m * layer_m.sizes().z();
  for (const ForceLine& line : lines) {
    const Span x = span(line.from_m.x(), line.to_m.x(), low.x(), cell_m, columns);
    const Span y = span(line.from_m.y(), line.to_m.y(), low.y(), cell_m, rows);
    for (int j = y.first; j <= y.last; ++j) {
      for (int i = x.first; i <= x.last; ++i) {
        const Eigen::Vector3d corner = low + Eigen::Vector3d(i * cell_m, j * cell_m, 0);
        const Eigen::AlignedBox3d box(
            corner, corner + Eigen::Vector3d(cell_m, cell_m, layer_m.sizes().z()));
        zz_Pa[std::size_t(j) * std::size_t(columns) + std::size_t(i)] +=
            share_in(line.from_m, line.to_m, box) * line.f_N.z() *
            (line.from_m.z() - line.to_m.z()) / volume_m3;
      }
    }
  }
  return zz_Pa;
}

}  // namespace

Eigen::Matrix3d box_stress_Pa(const std::vector<ForceLine>& lines,
                              const Eigen::AlignedBox3d& box_m) {
  Eigen::Matrix3d sum_Nm = Eigen::Matrix3d::Zero();
  for (const ForceLine& line : lines) {
    const double share = share_in(line.from_m, line.to_m, box_m);
    if (share > 0) sum_Nm += share * line.f_N * (line.from_m - line.to_m).transpose();
  }
  return sum_Nm / box_m.volume();
}

LayerForces layer_forces(const std::vector<ForceLine>& lines, const Footprint& plan, double top_m,
                         double thickness_m, int layers) {
  LayerForces sum{top_m, thickness_m, std::vector<double>(std::size_t(layers)),
                  std::vector<double>(std::size_t(layers))};
  constexpr int kPieces = 16;  // of a line: where it is in the plan is asked for each
  for (const ForceLine& line : lines) {
    const double low = std::min(line.from_m.z(), line.to_m.z());
    const double high = std::max(line.from_m.z(), line.to_m.z());
    if (low > top_m || high < top_m - layers * thickness_m) continue;
    const Eigen::Vector3d piece = (line.to_m - line.from_m) / kPieces;
    const double carried_Nm = -line.f_N.z() * piece.z();
    for (int k = 0; k < kPieces; ++k) {
      const Eigen::Vector3d p = line.from_m + (k + 0.5) * piece;
      const int layer = int(std::floor((top_m - p.z()) / thickness_m));
      if (layer < 0 || layer >= layers) continue;
      const std::uint8_t above = plan.at(p.x(), p.y());
      if (above == Footprint::kNone) continue;
      (above == Footprint::kGap ? sum.gap_N : sum.foot_N)[std::size_t(layer)] +=
          carried_Nm / thickness_m;
    }
  }
  return sum;
}

StressCut stress_cut(const std::vector<ForceLine>& lines, const Eigen::AlignedBox3d& slab_m,
                     double cell_m) {
  StressCut cut{slab_m.min().x(),
                slab_m.min().z(),
                cell_m,
                std::max(1, int(slab_m.sizes().x() / cell_m)),
                std::max(1, int(slab_m.sizes().z() / cell_m)),
                {}};
  cut.zz_Pa.resize(std::size_t(cut.columns) * std::size_t(cut.rows));
  const double volume_m3 = cell_m * cell_m * slab_m.sizes().y();
  for (const ForceLine& line : lines) {
    const Span x = span(line.from_m.x(), line.to_m.x(), cut.low_x_m, cell_m, cut.columns);
    const Span z = span(line.from_m.z(), line.to_m.z(), cut.low_z_m, cell_m, cut.rows);
    for (int j = z.first; j <= z.last; ++j) {
      for (int i = x.first; i <= x.last; ++i) {
        Eigen::AlignedBox3d box = slab_m;
        box.min().x() = cut.low_x_m + i * cell_m, box.max().x() = box.min().x() + cell_m;
        box.min().z() = cut.low_z_m + j * cell_m, box.max().z() = box.min().z() + cell_m;
        cut.zz_Pa[std::size_t(j) * std::size_t(cut.columns) + std::size_t(i)] +=
            share_in(line.from_m, line.to_m, box) * line.f_N.z() *
            (line.from_m.z() - line.to_m.z()) / volume_m3;
      }
    }
  }
  return cut;
}

SupportArea support_area(const std::vector<ForceLine>& lines, const std::vector<ForceLine>& before,
                         const Eigen::AlignedBox3d& layer_m, double cell_m, double threshold_Pa) {
  const int columns = std::max(1, int(layer_m.sizes().x() / cell_m));
  const int rows = std::max(1, int(layer_m.sizes().y() / cell_m));
  const std::vector<double> now = layer_zz_Pa(lines, layer_m, cell_m, columns, rows);
  const std::vector<double> then = layer_zz_Pa(before, layer_m, cell_m, columns, rows);
  SupportArea area;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double added_Pa = std::max(0.0, now[i] - then[i]);
    if (added_Pa > threshold_Pa) area.above_m2 += cell_m * cell_m;
    sum += added_Pa, squares += added_Pa * added_Pa;
  }
  if (squares > 0) area.participation_m2 = sum * sum / squares * cell_m * cell_m;
  return area;
}

}  // namespace hoof::tools
