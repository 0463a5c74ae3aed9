// Symbols: i motor current, A; duty of the bridge.
//   supply = nominal - resistance |i duty|
#include <cmath>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class SupplySag final : public JointEffect {
 public:
  explicit SupplySag(std::span<const double> values) : resistance_ohm_(values[0]) {}

  unsigned stages() const override { return kSupplyStage; }

  double supply_V(double supply_V, double current_A, double duty) const override {
    return supply_V - resistance_ohm_ * std::abs(current_A * duty);
  }

 private:
  double resistance_ohm_;
};

}  // namespace

EffectInfo supply_sag_effect() {
  return {
      .name = "supply_sag",
      .plug_in = PlugIn::kDrive,
      .summary = "a supply that gives way under load",
      .equation = "supply = nominal - resistance * |current * duty|",
      .source =
          "a bridge draws current * duty from its supply: Mohan, Undeland, Robbins, "
          "Power Electronics, 3rd ed., ch. 7",
      .parameters = {{"resistance", "ohm", 0, 100, 1, true, false, {1}}},
      .experiment = "record the supply voltage, or hold one load for 60 s on a regulated supply",
      .make_joint = [](std::span<const double> values) {
        return std::make_unique<SupplySag>(values);
      }};
}

}  // namespace hoof::sim
