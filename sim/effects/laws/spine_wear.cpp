// Symbols: none.
//   spine length = declared - loss
//
// Acts where a foot is built: its spines are made that much shorter, down to nothing.

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class SpineWear final : public SoilEffect {
 public:
  explicit SpineWear(std::span<const double> values) : loss_m_(values[0]) {}

  double spine_loss_m() const override { return loss_m_; }

 private:
  double loss_m_;
};

}  // namespace

EffectInfo spine_wear_effect() {
  return {
      .name = "spine_wear",
      .plug_in = PlugIn::kTerrain,
      .summary = "the sole's spines are shorter than declared",
      .equation = "spine length = declared - loss",
      .source = "Archard: J. Appl. Phys. 24 (1953) 981, wear grows with load and sliding distance",
      .parameters = {{"loss", "m", 0.0, 0.05, 4e-3, true, false, {2e-3}}},
      .experiment = "measure the spines; or press the foot into shallow sand and on a rigid floor",
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<SpineWear>(values);
      }};
}

}  // namespace hoof::sim
