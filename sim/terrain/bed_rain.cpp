#include "sim/terrain/bed_rain.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "sim/terrain/bed_grading.h"

namespace hoof::sim {

Rain::Rain(const BedSettings& bed, double column_m, std::uint64_t seed)
    : bed_(bed), column_m_(column_m), random_(seed) {
  diameters_m_ = graded_diameters(bed, grains_to_pour(bed, kSettledShare));
  // The largest first: they find a place while there is much room.
  std::sort(diameters_m_.begin(), diameters_m_.end(), std::greater<>());
  grains_.reserve(diameters_m_.size());
  const double cell_m = bed.largest_diameter_m();
  nx_ = std::max(1, int(bed.box_length_m / cell_m));
  ny_ = std::max(1, int(bed.box_width_m / cell_m));
  nz_ = std::max(1, int(column_m / cell_m));
  cells_.resize(std::size_t(nx_) * ny_ * nz_);
}

bool Rain::pour(std::size_t n) {
  // At the share they are poured with, the last grains need some hundred tries each.
  constexpr int kTries = 20000;
  const std::size_t end = std::min(diameters_m_.size(), grains_.size() + n);
  while (grains_.size() < end) {
    const double radius_m = diameters_m_[grains_.size()] / 2;
    int tries = 0;
    Eigen::Vector3d p_m;
    do {
      if (++tries > kTries) {
        throw std::runtime_error("bed: no room for grain " + std::to_string(grains_.size()) +
                                 " of " + std::to_string(diameters_m_.size()) +
                                 " in the rain: a smaller bed.rain_share_ratio than " +
                                 to_text(Value(bed_.rain_share)) + " leaves more");
      }
      p_m = random_place(radius_m);
    } while (!free(p_m, radius_m));
    cells_[index(cell_of(p_m.x(), bed_.box_length_m, nx_), cell_of(p_m.y(), bed_.box_width_m, ny_),
                 cell_of(p_m.z(), column_m_, nz_))]
        .push_back({p_m, radius_m});
    Grain g;
    g.id = std::uint32_t(grains_.size());
    g.radius_m = radius_m;
    g.p_m = p_m - Eigen::Vector3d(bed_.box_length_m / 2, bed_.box_width_m / 2, bed_.depth_m);
    grains_.push_back(g);
  }
  return grains_.size() < diameters_m_.size();
}

Eigen::Vector3d Rain::random_place(double radius_m) {
  const double side_m = bed_.periodic_sides ? 0 : radius_m;
  const double x = random_.between(side_m, bed_.box_length_m - side_m);
  const double y = random_.between(side_m, bed_.box_width_m - side_m);
  const double z = random_.between(radius_m, column_m_ - radius_m);
  return {x, y, z};
}

int Rain::cell_of(double x_m, double length_m, int n) const {
  return std::clamp(int(x_m / length_m * n), 0, n - 1);
}

bool Rain::free(const Eigen::Vector3d& p_m, double radius_m) const {
  const int x = cell_of(p_m.x(), bed_.box_length_m, nx_);
  const int y = cell_of(p_m.y(), bed_.box_width_m, ny_);
  const int z = cell_of(p_m.z(), column_m_, nz_);
  // Most places are taken, and most of these by a grain of the same cell: it is asked first.
  if (!cell_free(x, y, z, p_m, radius_m)) return false;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0 && dz == 0) continue;
        if (!cell_free(x + dx, y + dy, z + dz, p_m, radius_m)) return false;
      }
    }
  }
  return true;
}

bool Rain::cell_free(int x, int y, int z, const Eigen::Vector3d& p_m, double radius_m) const {
  if (z < 0 || z >= nz_) return true;
  if (!bed_.periodic_sides && (x < 0 || x >= nx_ || y < 0 || y >= ny_)) return true;
  for (const Placed& q : cells_[index((x + nx_) % nx_, (y + ny_) % ny_, z)]) {
    Eigen::Vector3d d = p_m - q.p_m;
    if (bed_.periodic_sides) {
      d.x() -= bed_.box_length_m * std::round(d.x() / bed_.box_length_m);
      d.y() -= bed_.box_width_m * std::round(d.y() / bed_.box_width_m);
    }
    const double reach_m = radius_m + q.radius_m;
    if (d.squaredNorm() < reach_m * reach_m) return false;
  }
  return true;
}

}  // namespace hoof::sim
