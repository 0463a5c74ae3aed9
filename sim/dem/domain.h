// Fixed-point coordinates: the domain is 2^32 steps wide along each axis (2^64 in double
// precision).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "sim/dem/grain_record.h"

namespace hoof::sim {

/// Coordinates of a record without the part below one step, of either precision.
struct WholeSteps {
  std::int64_t x, y, z;
};

/// Along a periodic axis the domain is the period; along a walled one it must contain every grain
/// with room to spare, since a grain that leaves it comes in again on the other side.
struct Domain {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::array<bool, 3> periodic{};

  static Domain spanning(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m,
                         std::array<bool, 3> periodic) {
    return {low_m, high_m - low_m, periodic};
  }

  double length_m(int axis) const { return size_m[axis]; }

  /// Width of one step of a record's coordinates, m.
  template <typename Real>
  double lsb_m(int axis) const {
    return size_m[axis] * (sizeof(typename GrainRecord<Real>::Steps) == 4 ? 0x1p-32 : 0x1p-64);
  }

  /// Step below a coordinate inside the domain, and the rest in steps.
  template <typename Real>
  typename GrainRecord<Real>::Steps to_steps(int axis, double x_m, double& rest) const {
    using Steps = typename GrainRecord<Real>::Steps;
    const double share = (x_m - origin_m[axis]) / size_m[axis];  // in [0, 1)
    const double steps = share * (sizeof(Steps) == 4 ? 0x1p32 : 0x1p64);
    const double whole = std::floor(steps);
    rest = steps - whole;
    return Steps(std::make_unsigned_t<Steps>(whole));
  }

  /// Way of a grain from where its coordinates had the whole steps `since`, across periodic sides.
  template <typename Real>
  Eigen::Vector3d moved_m(const GrainRecord<Real>& p, const WholeSteps& since) const {
    using Steps = typename GrainRecord<Real>::Steps;
    using Unsigned = std::make_unsigned_t<Steps>;
    const auto steps = [](Steps now, std::int64_t then) {  // wraps where the domain does
      return double(Steps(Unsigned(now) - Unsigned(then)));
    };
    double rest[3] = {0, 0, 0};
    if constexpr (sizeof(Real) == 4) rest[0] = p.rx, rest[1] = p.ry, rest[2] = p.rz;
    return {lsb_m<Real>(0) * (steps(p.x, since.x) + rest[0]),
            lsb_m<Real>(1) * (steps(p.y, since.y) + rest[1]),
            lsb_m<Real>(2) * (steps(p.z, since.z) + rest[2])};
  }

  template <typename Real>
  Eigen::Vector3d position_m(const GrainRecord<Real>& p) const {
    using Unsigned = std::make_unsigned_t<typename GrainRecord<Real>::Steps>;
    double rest[3] = {0, 0, 0};
    if constexpr (sizeof(Real) == 4) rest[0] = p.rx, rest[1] = p.ry, rest[2] = p.rz;
    return {origin_m.x() + lsb_m<Real>(0) * (double(Unsigned(p.x)) + rest[0]),
            origin_m.y() + lsb_m<Real>(1) * (double(Unsigned(p.y)) + rest[1]),
            origin_m.z() + lsb_m<Real>(2) * (double(Unsigned(p.z)) + rest[2])};
  }
};

}  // namespace hoof::sim
