// Symbols: q true output angle, rad.
//   measured = q + amplitude sin(q + phase); the drive sees it too
#include <cmath>
#include <numbers>

#include "sim/effects/effect.h"

namespace hoof::sim {
namespace {

class EncoderEccentricity final : public JointEffect {
 public:
  explicit EncoderEccentricity(std::span<const double> values)
      : amplitude_rad_(values[0]), phase_rad_(values[1]) {}

  unsigned stages() const override { return kSensorStage; }

  double reading_rad(double q_rad) const override {
    return q_rad + amplitude_rad_ * std::sin(q_rad + phase_rad_);
  }
  double reading_slope(double q_rad) const override {
    return 1 + amplitude_rad_ * std::cos(q_rad + phase_rad_);
  }

 private:
  double amplitude_rad_, phase_rad_;
};

}  // namespace

EffectInfo encoder_eccentricity_effect() {
  return {.name = "encoder_eccentricity",
          .plug_in = PlugIn::kSensor,
          .summary = "an encoder disc off its axis: readings wander once per turn",
          .equation = "measured = q + amplitude * sin(q + phase)",
          .source =
              "Hanselman, Signal processing techniques for improved resolver-to-digital "
              "conversion accuracy, IECON 1990",
          .parameters = {{"amplitude", "rad", 0, 0.5, 0.03, true, false, {0.03}},
                         {"phase",
                          "rad",
                          -std::numbers::pi,
                          std::numbers::pi,
                          2,
                          false,
                          true,
                          {0, 0.5 * std::numbers::pi}}},
          .experiment =
              "a whole slow turn beside a second, true angle sensor, or free swings at "
              "several angles",
          .make_joint = [](std::span<const double> values) {
            return std::make_unique<EncoderEccentricity>(values);
          }};
}

}  // namespace hoof::sim
