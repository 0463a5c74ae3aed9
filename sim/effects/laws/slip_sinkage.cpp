// Symbols: z depth, m; j shear displacement so far, m.
//   resistance(z) = F(z - coefficient j)
//
// A contact that shears the sand digs itself in: at the same load it stands coefficient j deeper.
// Seen from the depth, the ground it rests on lies coefficient j lower, at most at its own level.
#include <algorithm>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class SlipSinkage final : public SoilEffect {
 public:
  explicit SlipSinkage(std::span<const double> values) : coefficient_(values[0]) {}

  double extra_depth_m(const SoilContact& contact) const override {
    return -std::clamp(coefficient_ * contact.shear_m, 0.0, std::max(contact.depth_m, 0.0));
  }

 private:
  double coefficient_;
};

}  // namespace

EffectInfo slip_sinkage_effect() {
  return {.name = "slip_sinkage",
          .plug_in = PlugIn::kTerrain,
          .summary = "a foot or wheel that slips digs itself in",
          .equation = "resistance(z) = F(z - coefficient j)",
          .source =
              "Lyasko: J. Terramechanics 47 (2010) 21, slip sinkage; Ding et al.: J. "
              "Terramechanics 48 (2011) 27",
          .parameters = {{"coefficient", "1", 0.0, 5, 0.2, true, false, {0.1}}},
          .experiment = "hold one load and drag the foot by a foot length, with its depth recorded",
          .make_soil = [](std::span<const double> values) {
            return std::make_unique<SlipSinkage>(values);
          }};
}

}  // namespace hoof::sim
