// What the foot covers seen from above, and the gaps between its toes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "tools/fields/foot_shape.h"

namespace hoof::tools {

/// A raster of the plan, cells of kCell_m: which body is above, or that a gap is. A gap is what
/// lies, along y, between two different bodies at least kNarrowest_m apart. Spines are left out.
class Footprint {
 public:
  static constexpr double kCell_m = 1e-3;
  static constexpr double kNarrowest_m = 2e-3;  // closed toes begin 0.5 mm from the middle
  static constexpr std::uint8_t kNone = 0xff, kGap = 0xfe;

  Footprint(const PlacedFoot& foot, const Eigen::AlignedBox3d& region_m);

  /// Index of the body above a point, kGap or kNone.
  std::uint8_t at(double x_m, double y_m) const;
  bool covers(double x_m, double y_m) const { return at(x_m, y_m) < kGap; }
  double foot_area_m2() const { return foot_area_m2_; }
  double gap_area_m2() const { return gap_area_m2_; }

 private:
  void cover(const FootTriangle& t);
  void find_gaps();

  Eigen::Vector2d low_m_;
  int columns_, rows_;  // along x and y
  std::vector<std::uint8_t> cells_;
  double foot_area_m2_ = 0, gap_area_m2_ = 0;
};

}  // namespace hoof::tools
