// Symbols: z depth, m.
//   depth = z + shift

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class UnlistedSurfaceOffset final : public SoilEffect {
 public:
  explicit UnlistedSurfaceOffset(std::span<const double> values) : shift_m_(values[0]) {}

  double extra_depth_m(const SoilContact&) const override { return shift_m_; }

 private:
  double shift_m_;
};

}  // namespace

EffectInfo unlisted_surface_offset_effect() {
  return {.name = "unlisted_surface_offset",
          .plug_in = PlugIn::kTerrain,
          .summary = "the sand stands higher or lower than stated",
          .equation = "depth = z + shift",
          .source = "a stand-in: surfaces are levelled and found by hand",
          .parameters = {{"shift", "m", -0.05, 0.05, 1e-3, false, false, {5e-4, -5e-4}}},
          .experiment = "find the surface by a slow touch before each press",
          .listed = false,
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<UnlistedSurfaceOffset>(values);
          }};
}

}  // namespace hoof::sim
