// The particle factory: grains at random places above the floor, none touching another.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/dem/grain.h"
#include "sim/terrain/bed_settings.h"
#include "sim/terrain/random.h"

namespace hoof::sim {

/// Places the grains of one bed a few at a time. Which places they get depends on bed, column and
/// seed alone, not on how many are asked for at once.
class Rain {
 public:
  /// @param column_m height above the floor up to which grains are placed
  Rain(const BedSettings& bed, double column_m, std::uint64_t seed);

  /// Places up to n more grains; false once all are there.
  /// @throws std::runtime_error where no room is found for one
  bool pour(std::size_t n);

  double share_done() const { return double(grains_.size()) / double(diameters_m_.size()); }

  /// The grains so far, their ids from 0 on.
  const std::vector<Grain>& grains() const { return grains_; }

 private:
  struct Placed {
    Eigen::Vector3d p_m;  // from the corner of the box
    double radius_m;
  };

  bool free(const Eigen::Vector3d& p_m, double radius_m) const;
  bool cell_free(int x, int y, int z, const Eigen::Vector3d& p_m, double radius_m) const;
  int cell_of(double x_m, double length_m, int n) const;
  std::size_t index(int x, int y, int z) const { return (std::size_t(z) * ny_ + y) * nx_ + x; }
  Eigen::Vector3d random_place(double radius_m);

  BedSettings bed_;
  double column_m_;
  Random random_;
  std::vector<double> diameters_m_;
  std::vector<Grain> grains_;
  int nx_, ny_, nz_;
  std::vector<std::vector<Placed>> cells_;  // at least as wide as the largest grain
};

}  // namespace hoof::sim
