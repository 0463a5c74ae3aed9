// Elastic and contact values of sand and of the foot's plastic, with source and doubt.
#pragma once

#include "sim/config/reader.h"

namespace hoof::sim {

struct Material {
  Measured young_Pa;
  Measured poisson;
  Measured density_kg_m3;
};

/// Values of a pair of materials.
struct ContactPair {
  /// Ratio of normal relative speed after and before an impact.
  Measured restitution;
  /// Coulomb coefficient.
  Measured static_friction;
  /// Rolling torque over (normal force times grain radius).
  Measured rolling_friction;
};

struct Materials {
  Material sand;
  /// Foot and box walls.
  Material abs;
  ContactPair sand_sand;
  ContactPair sand_abs;
};

/// Reads the section "materials" of a run.
Materials read_materials(Reader section);

}  // namespace hoof::sim
