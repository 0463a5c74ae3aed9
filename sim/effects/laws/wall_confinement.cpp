// Symbols: z depth, m.
//   force = F (1 + coefficient (z / distance)^2)
//
// distance: from the plate to the wall, setup key wall_distance. Where it is not known, 0.1 m: then
// only coefficient / distance^2 is found, and the coefficient is that of a wall 0.1 m away.

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class WallConfinement final : public SoilEffect {
 public:
  explicit WallConfinement(std::span<const double> values) : coefficient_(values[0]) {}

  double strength_N(double force_N, const SoilContact& contact) const override {
    constexpr double kReference_m = 0.1;
    const double distance_m = contact.wall_distance_m > 0 ? contact.wall_distance_m : kReference_m;
    const double ratio = contact.depth_m / distance_m;
    return force_N * (1 + coefficient_ * ratio * ratio);
  }

 private:
  double coefficient_;
};

}  // namespace

EffectInfo wall_confinement_effect() {
  return {
      .name = "wall_confinement",
      .plug_in = PlugIn::kTerrain,
      .summary = "the zone of failure reaches a wall, and the force grows faster with depth",
      .equation = "force = F (1 + coefficient (z / distance)^2)",
      .source =
          "Seguin, Bertho, Gondret: Phys. Rev. E 78 (2008) 010301, penetration in a confined bed",
      .parameters = {{"coefficient", "1", 0.0, 1e3, 3, true, false, {3}}},
      .experiment = "press the same plate in the middle and close to a wall of the box",
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<WallConfinement>(values);
      }};
}

}  // namespace hoof::sim
