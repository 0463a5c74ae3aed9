// Fixed-point coordinates: the domain is 2^32 steps wide along each axis.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "sim/dem/grain_record.h"

namespace hoof::sim {

/// Along a periodic axis the domain is the period; along a walled one it must contain every grain
/// with room to spare, since a grain that leaves it comes in again on the other side.
struct Domain {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d lsb_m = Eigen::Vector3d::Zero();
  std::array<bool, 3> periodic{};

  static Domain spanning(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
                         std::array<bool, 3> periodic) {
    return {low_m, (high_m - low_m) / 4294967296.0, periodic};
  }

  double length_m(int axis) const { return lsb_m[axis] * 4294967296.0; }

  /// Nearest step of a coordinate, and the rest in steps.
  std::int32_t to_steps(int axis, double x_m, double& rest) const {
    const double steps = (x_m - origin_m[axis]) / lsb_m[axis];
    const double whole = std::floor(steps);
    rest = steps - whole;
    return std::int32_t(std::uint32_t(std::int64_t(whole)));
  }

  template <typename Real>
  Eigen::Vector3d position_m(const GrainRecord<Real>& p) const {
    return {origin_m.x() + lsb_m.x() * (double(std::uint32_t(p.x)) + double(p.rx)),
            origin_m.y() + lsb_m.y() * (double(std::uint32_t(p.y)) + double(p.ry)),
            origin_m.z() + lsb_m.z() * (double(std::uint32_t(p.z)) + double(p.rz))};
  }
};

}  // namespace hoof::sim
