// Where optional physics acts on ground that is pressed.
#pragma once

#include <memory>
#include <span>

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
  double time_s = 0;           // since the recording or run began
  /// The nominal law: force = stiffness depth^exponent. Bekker's is A (k_c/b + k_phi) and n; a
  /// pressure that grows with depth, as in resistive force theory, has exponent 1.
  double stiffness_N_m = 0;  // N/m^exponent
  double exponent = 1;
};

/// The four force stages are asked in this order, at each stage every effect in the order of the
/// catalogue. Only the last may remember: the others are asked again while a depth is sought.
class SoilEffect {
 public:
  virtual ~SoilEffect() = default;

  /// Before a recording or run: forgets what went before.
  virtual void reset() {}

  /// 1. What becomes of the nominal strength, the one that grows with depth.
  virtual double strength_N(double force_N, const SoilContact& /*contact*/) const {
    return force_N;
  }
  /// 2. What becomes of the whole resistance.
  virtual double force_N(double force_N, const SoilContact& /*contact*/) const { return force_N; }
  /// 3. Only while the contact is above its deepest point.
  /// @param deepest_N what stages 1 and 2 give there, at the same speed: loading again joins on
  virtual double unloading_N(double force_N, double /*deepest_N*/,
                             const SoilContact& /*contact*/) const {
    return force_N;
  }
  /// 4. What is measured; also out of the ground. Asked once per sample, in order of time.
  virtual double measured_N(double force_N, const SoilContact& /*contact*/) { return force_N; }

  /// Depth beside the one that the height above the level surface shows.
  virtual double extra_depth_m(const SoilContact& /*contact*/) const { return 0; }
  /// Travel that the rig itself makes under a force.
  virtual double rig_travel_m(double /*force_N*/) const { return 0; }
  /// How much shorter the spines of a foot are than declared.
  virtual double spine_loss_m() const { return 0; }
};

using SoilEffects = std::span<const std::unique_ptr<SoilEffect>>;

/// Stages 1 to 3 on the nominal law, at contact.depth_m as it stands. Zero out of the ground, never
/// tension. Beyond deepest_m the contact loads.
double soil_force_N(const SoilContact& contact, SoilEffects effects);

/// Of all effects together.
double rig_travel_m(double force_N, SoilEffects effects);
double extra_depth_m(const SoilContact& contact, SoilEffects effects);
double spine_loss_m(SoilEffects effects);

}  // namespace hoof::sim
