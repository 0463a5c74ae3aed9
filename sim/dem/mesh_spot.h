// The spots where a mesh touches a sphere, and which of them are one and the same.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace hoof::sim {

/// The closest point of one triangle, seen from a sphere's centre. All in the body's frame.
struct MeshSpot {
  Eigen::Vector3d point_m;
  Eigen::Vector3d to_centre_m;  // from the point
  Eigen::Vector3d normal;       // unit; towards the centre, or out of the body that it is inside of
  double distance_m = 0;        // of the centre, along the normal: negative inside a closed body
  double overlap_m = 0;         // of the sphere
  std::uint32_t facet = 0;
  bool on_border = false;  // of the triangle
};

/// The spot nearest to the centre, of at least one.
const MeshSpot& nearest(const std::vector<MeshSpot>& spots);

/// Takes what is outside the body for its inside.
void turn_inside_out(std::vector<MeshSpot>& spots);

/// Leaves the spots that push the sphere, each with the overlap it pushes with, nearest first.
///
/// A face, the edges around it and their corners are one flattened place, not several contacts. A
/// spot counts only as far as it stands out of the tangent plane of every nearer one: at a convex
/// edge or on a flat it never does, in a corner, or between two spines, it does. Two spots of
/// overlap delta have contact discs of radius sqrt(r delta), which are apart where one stands out
/// by 2 delta; up to there the overlap is half of what stands out, so that the seams of a hollow,
/// finely cut surface are not felt twice either. A spot on the border of its triangle is shared
/// with a neighbour; where that comes nearer to the centre the spot is no place of contact at all,
/// which shows in the neighbour's own spot: a triangle lies behind the plane through its closest
/// point.
/// @param spots of one closed body or of one sheet; seen from outside unless turned inside out
void keep_distinct(std::vector<MeshSpot>& spots, double radius_m);

}  // namespace hoof::sim
