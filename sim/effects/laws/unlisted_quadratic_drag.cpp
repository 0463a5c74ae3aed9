// A stand-in for physics that the list does not hold.
//   torque = -coefficient w |w|
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class QuadraticDrag final : public JointEffect {
 public:
  explicit QuadraticDrag(std::span<const double> values) : c_(values[0]) {}

  unsigned stages() const override { return kLinkStage; }

  double link_torque_Nm(double /*q*/, double w, double /*t*/) override {
    return -c_ * w * std::abs(w);
  }

 private:
  double c_;
};

}  // namespace

EffectInfo unlisted_quadratic_drag_effect() {
  return {.name = "unlisted_quadratic_drag",
          .plug_in = PlugIn::kJoint,
          .summary = "drag that grows with the square of speed",
          .equation = "torque = -coefficient w |w|",
          .source = "quadratic friction, model M6 of Duclusaud et al. 2025",
          .parameters = {{"coefficient", "Nm s2/rad2", -1e3, 1e3, 0.01, false, false, {0.01}}},
          .experiment = "free swings and fast sweeps at several speeds",
          .listed = false,
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<QuadraticDrag>(values);
          }};
}

}  // namespace hoof::sim
