#include "firmware/control/adaptive_opening.h"

namespace hoof::firmware::control {

void AdaptiveOpening::start(float ordered_rad) {
  ordered_rad_ = ordered_rad;
  deepest_m_ = 0.0f;
  felt_ = false;
  moved_ = false;
}

std::optional<float> AdaptiveOpening::update(const GroundEstimate& ground, bool below_sand,
                                             bool may_move, float target_rad) {
  if (!settings_.is_enabled()) return std::nullopt;
  if (ground.contact) {
    if (!below_sand) return std::nullopt;
    felt_ = true;
    if (ground.sinkage_m > deepest_m_) deepest_m_ = ground.sinkage_m;
    return std::nullopt;
  }
  if (!felt_ || !may_move) return std::nullopt;
  const float excess_m = deepest_m_ - settings_.reference_sinkage_m;
  felt_ = false;
  deepest_m_ = 0.0f;
  const float wished_rad =
      clamp(ordered_rad_ + settings_.gain_rad_m * excess_m, ordered_rad_, largest_angle_rad_);
  const float change_rad = wished_rad - target_rad;
  if (absolute(change_rad) <= settings_.gain_rad_m * settings_.deadband_m) return std::nullopt;
  moved_ = true;
  const float step_rad = clamp(change_rad, -settings_.largest_step_rad, settings_.largest_step_rad);
  return clamp(target_rad + step_rad, ordered_rad_, largest_angle_rad_);
}

}  // namespace hoof::firmware::control
