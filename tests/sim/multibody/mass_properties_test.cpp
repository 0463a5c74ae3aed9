#include "sim/multibody/mass_properties.h"

#include <catch2/catch.hpp>

#include "tests/sim/multibody/cube.h"

using namespace hoof::sim;
using Eigen::Vector3d;

TEST_CASE("a cuboid has the volume, centre and inertia of the text book") {
  const Vector3d size(0.2, 0.3, 0.5);
  const TriangleMesh mesh = make_cuboid({-1.0, 0.4, 2.0}, size);
  CHECK(volume_m3(mesh) == Approx(0.03).epsilon(1e-12));
  const MassProperties m = solid(mesh, 6.0);
  CHECK((m.com_B_m - Vector3d(-0.9, 0.55, 2.25)).norm() < 1e-12);
  // m/12 (b^2 + c^2); the centre is 2.5 m off, where 1e-16 of m r^2 = 40 is left as rounding.
  CHECK(m.inertia_kg_m2(0, 0) == Approx(0.5 * (0.09 + 0.25)).margin(1e-12));
  CHECK(m.inertia_kg_m2(1, 1) == Approx(0.5 * (0.04 + 0.25)).margin(1e-12));
  CHECK(m.inertia_kg_m2(2, 2) == Approx(0.5 * (0.04 + 0.09)).margin(1e-12));
  CHECK(std::abs(m.inertia_kg_m2(0, 1)) < 1e-12);
}

TEST_CASE("two halves joined make the whole") {
  const MassProperties whole = solid(make_cuboid({0, 0, 0}, {0.2, 0.1, 0.1}), 2.0);
  const MassProperties a = solid(make_cuboid({0, 0, 0}, {0.1, 0.1, 0.1}), 1.0);
  const MassProperties b = solid(make_cuboid({0.1, 0, 0}, {0.1, 0.1, 0.1}), 1.0);
  const MassProperties both = joined(a, b);
  CHECK(both.mass_kg == Approx(2.0));
  CHECK((both.com_B_m - whole.com_B_m).norm() < 1e-15);
  CHECK((both.inertia_kg_m2 - whole.inertia_kg_m2).norm() < 1e-15);
}
