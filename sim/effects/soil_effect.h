// Where optional physics acts on ground that is pressed.
#pragma once

namespace hoof::sim {

/// A plate or facet in the ground, as an effect sees it.
struct SoilContact {
  double depth_m = 0;    // below the level surface, positive in the ground
  double deepest_m = 0;  // of this press so far
  double speed_m_s = 0;  // downward
  double area_m2 = 0;
  double width_m = 0;          // b: the smaller dimension; the radius of a disc
  double wall_distance_m = 0;  // 0: not known
  int press = 0;               // how many presses went before
  double shear_m = 0;          // shear displacement so far
};

class SoilEffect {
 public:
  virtual ~SoilEffect() = default;

  /// Before a press.
  virtual void reset() {}
  /// What becomes of the nominal force; in the order of the catalogue.
  virtual double force_N(double force_N, const SoilContact& /*contact*/) { return force_N; }
  /// Depth beside the one the carriage shows.
  virtual double extra_depth_m(const SoilContact& /*contact*/) const { return 0; }
  /// Travel that the rig itself makes under a force.
  virtual double rig_travel_m(double /*force_N*/) const { return 0; }
};

}  // namespace hoof::sim
