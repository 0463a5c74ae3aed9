#pragma once

#include <numbers>

#include "sim/config/materials.h"
#include "tools/calibrate/findings.h"

namespace hoof::tests {

inline constexpr double kDegree = std::numbers::pi / 180;

/// The paper's materials with these coefficients of grain on plate.
inline sim::Materials sand(double e, double mu_s, double mu_r) {
  return tools::lab_materials("", {e, mu_s, mu_r}, &sim::Materials::sand_abs);
}

}  // namespace hoof::tests
