// Opening that follows the sand: deeper stances open the toes wider for the next. An option, off by
// default; the source paper leaves it as future work.
#pragma once

#include <optional>

#include "firmware/control/ground_contact.h"
#include "firmware/control/settings.h"

namespace hoof::firmware::control {

/// angle = ordered + gain (deepest sinkage of the stance - reference), between the ordered and the
/// largest angle, by one limited step per cycle and in the air only. It knows of the sand what
/// GroundContact knows, no more.
class AdaptiveOpening {
 public:
  AdaptiveOpening(const AdaptiveSettings& settings, float largest_angle_rad)
      : settings_(settings), largest_angle_rad_(largest_angle_rad) {}

  /// An order: begins at its angle with nothing learnt.
  void start(float ordered_rad);

  /// One tick of the gait.
  /// @param below_sand the path is below the level sand: what is felt now is a stance, not a fault
  ///                   of the estimate in the air
  /// @param may_move   the foot is in the air for longer than a step takes
  /// @param target_rad of the toes at present
  /// @return their new target, at most once per stance
  std::optional<float> update(const GroundEstimate& ground, bool below_sand, bool may_move,
                              float target_rad);

  /// The toes' latest target came from here and not from an order.
  bool moved() const { return moved_; }

 private:
  AdaptiveSettings settings_;
  float largest_angle_rad_;
  float ordered_rad_ = 0.0f;
  float deepest_m_ = 0.0f;  // since the last chance to move
  bool felt_ = false;       // a stance since then
  bool moved_ = false;
};

}  // namespace hoof::firmware::control
