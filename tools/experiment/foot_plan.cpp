#include "tools/experiment/foot_plan.h"

namespace hoof::tools {

Eigen::AlignedBox2d foot_plan_m(const sim::Foot& foot, double toe_rad) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& v : foot.middle.vertices_m) box.extend(v.head<2>());
  if (foot.has_toes) {
    const Eigen::Rotation2Dd turn(toe_rad);  // the left toe opens to +y
    for (const Eigen::Vector3d& v : foot.left_toe.vertices_m) {
      const Eigen::Vector2d p = foot.hinges.left_F_m.head<2>() + turn * v.head<2>();
      box.extend(p);
      box.extend(Eigen::Vector2d(p.x(), -p.y()));
    }
  }
  return box;
}

}  // namespace hoof::tools
