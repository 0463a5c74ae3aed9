// The outline of a foot as it stands on the ground.
#pragma once

#include <Eigen/Geometry>

#include "sim/multibody/foot.h"

namespace hoof::tools {

/// The box around the foot in x and y in its own frame, toes opened by toe_rad, m.
Eigen::AlignedBox2d foot_plan_m(const sim::Foot& foot, double toe_rad);

}  // namespace hoof::tools
