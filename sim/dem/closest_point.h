// Closest point of a triangle to a point: inside the face, on an edge or at a vertex.
// Source: region tests on the barycentric plane, C. Ericson, Real-Time Collision Detection (2005),
// section 5.1.5 (the idea; all three kinds of contact come from it alike).
#pragma once

#include <Eigen/Core>

namespace hoof::sim {

/// @param a, b, c the corners  @param p the point, same frame  @return the closest point
Eigen::Vector3d closest_point_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                          const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace hoof::sim
