// Closest point of a triangle to a point: inside the face, on an edge or at a vertex.
// Source: region tests on the barycentric plane, C. Ericson, Real-Time Collision Detection (2005),
// section 5.1.5 (the idea; all three kinds of contact come from it alike).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hoof::sim {

/// A triangle with what does not depend on the point worked out once.
struct Facet {
  Eigen::Vector3d a, ab, ac;  // a corner and the edges from it, m
  Eigen::Vector3d normal;     // unit, ab x ac
  double ab2, ab_ac, ac2;     // products of the edges, m^2

  Facet(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
};

/// Where on a triangle a point lies. The numbers are places in tables of normals.
enum class FacetPart : std::uint8_t {
  kCornerA,
  kCornerB,
  kCornerC,
  kEdgeAB,
  kEdgeBC,
  kEdgeCA,
  kInside
};

struct ClosestPoint {
  Eigen::Vector3d to_p_m;  // from the closest point to p; inside the face exactly along its normal
  FacetPart part;
};

ClosestPoint closest_point(const Facet& facet, const Eigen::Vector3d& p);

}  // namespace hoof::sim
