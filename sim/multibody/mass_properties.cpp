#include "sim/multibody/mass_properties.h"

#include <Eigen/Geometry>

namespace hoof::sim {
namespace {

/// Inertia of a point mass at r: m (r.r 1 - r r^T).
Eigen::Matrix3d point_inertia(double mass_kg, const Eigen::Vector3d& r) {
  return mass_kg * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

}  // namespace

double volume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    six_volumes += mesh.vertices_m[a].dot(mesh.vertices_m[b].cross(mesh.vertices_m[c]));
  }
  return six_volumes / 6.0;
}

MassProperties solid(const TriangleMesh& mesh, double mass_kg) {
  // A tetrahedron (0, a, b, c) of volume v has centroid (a+b+c)/4 and second moment
  // integral x x^T = v/20 (a a^T + b b^T + c c^T + s s^T) with s = a+b+c.
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [ia, ib, ic] : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices_m[ia];
    const Eigen::Vector3d& b = mesh.vertices_m[ib];
    const Eigen::Vector3d& c = mesh.vertices_m[ic];
    const Eigen::Vector3d s = a + b + c;
    const double v = a.dot(b.cross(c)) / 6.0;
    volume += v;
    first += v / 4.0 * s;
    second +=
        v / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  const double density = mass_kg / volume;
  const Eigen::Vector3d com = first / volume;
  const Eigen::Matrix3d about_origin =
      density * (second.trace() * Eigen::Matrix3d::Identity() - second);
  return {mass_kg, com, about_origin - point_inertia(mass_kg, com)};
}

MassProperties joined(const MassProperties& a, const MassProperties& b) {
  MassProperties both;
  both.mass_kg = a.mass_kg + b.mass_kg;
  both.com_B_m = (a.mass_kg * a.com_B_m + b.mass_kg * b.com_B_m) / both.mass_kg;
  both.inertia_kg_m2 = a.inertia_kg_m2 + point_inertia(a.mass_kg, a.com_B_m - both.com_B_m) +
                       b.inertia_kg_m2 + point_inertia(b.mass_kg, b.com_B_m - both.com_B_m);
  return both;
}

}  // namespace hoof::sim
