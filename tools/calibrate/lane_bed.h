// Single grains on or above one plate, each in a lane of its own so that none meets another: as
// many runs of a single-grain test as there are lanes, at once, in the grains' own engine in double
// precision.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/config/materials.h"
#include "sim/dem/sand_bed.h"

namespace hoof::tools {

/// Step of the single-grain laboratories, s: the source paper's, 13 % of the Rayleigh time of its
/// smallest grain.
inline constexpr double kLabStep_s = 2.8e-6;

/// Constants of the engine for these materials: grain on grain sand_sand, on walls and meshes
/// sand_abs; gravity down; one thread.
sim::DemSettings lab_settings(const sim::Materials& materials);

/// Unit vectors of a plate turned by `tilt` about y: along it downhill (+x), and out of it.
struct PlateFrame {
  explicit PlateFrame(double tilt_rad);
  Eigen::Vector3d downhill, normal;
};

/// How one grain begins its test.
struct LaneStart {
  double diameter_m = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  // y is the lane's
};

/// A plate that ends, as a closed block: its face goes through the origin, from `up` above it to
/// `down` below it along the slope.
struct Plate {
  double tilt_rad = 0;
  double up_m = 0;
  double down_m = 0;
};

class LaneBed {
 public:
  /// @param low_z, high_z, far_x heights and distance that the grains may reach, m
  LaneBed(const sim::Materials& materials, const std::vector<LaneStart>& starts, const Plate& plate,
          double low_z_m, double high_z_m, double far_x_m);

  void advance(int steps) { bed_.advance(steps); }
  /// In the order of the starts; y about the lane's middle.
  std::vector<sim::Grain> grains() const;

 private:
  double lane_y_m(std::size_t lane) const;

  double pitch_m_;
  std::size_t count_;
  sim::SandBed bed_;
};

/// Diameters for n grains of the paper's grading (2 to 6.4 mm), m, from small to large; one grain
/// alone is of 4 mm.
std::vector<double> lab_diameters(int n);

/// Overlap at which a wall carries `force`, m (Hertz, contact_law.h).
double resting_overlap_m(const sim::Materials& materials, double radius_m, double force_N);

double grain_mass_kg(const sim::Materials& materials, double radius_m);

}  // namespace hoof::tools
