// Symbols: F push force, N.
//   measured travel = true depth + compliance F
//
// The measured height is that of the carriage: the plate is compliance F less deep than it shows.
// On a rigid block the whole travel after contact is compliance F.

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class RigCompliance final : public SoilEffect {
 public:
  explicit RigCompliance(std::span<const double> values) : compliance_m_N_(values[0]) {}

  double rig_travel_m(double force_N) const override { return compliance_m_N_ * force_N; }

 private:
  double compliance_m_N_;
};

}  // namespace

EffectInfo rig_compliance_effect() {
  return {
      .name = "rig_compliance",
      .plug_in = PlugIn::kRig,
      .summary =
          "the rig bends under its own force, so that the plate is less deep than the carriage "
          "shows",
      .equation = "measured travel = true depth + compliance F",
      .source = "Oliver, Pharr: J. Mater. Res. 7 (1992) 1564, load frame compliance; ISO 14577-1",
      .parameters = {{"compliance", "m/N", 0.0, 1e-2, 1e-5, true, false, {1e-5}}},
      .experiment =
          "press on a rigid block to the same force: the travel after contact is the rig's alone",
      .make_soil = [](std::span<const double> values) {
        return std::make_unique<RigCompliance>(values);
      }};
}

}  // namespace hoof::sim
