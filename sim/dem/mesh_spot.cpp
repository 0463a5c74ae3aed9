#include "sim/dem/mesh_spot.h"

#include <algorithm>
#include <cmath>

namespace hoof::sim {
namespace {

bool is_nearer(const MeshSpot& a, const MeshSpot& b) {
  const double da = std::abs(a.distance_m), db = std::abs(b.distance_m);
  return da != db ? da < db : a.facet < b.facet;
}

}  // namespace

const MeshSpot& nearest(const std::vector<MeshSpot>& spots) {
  return *std::min_element(spots.begin(), spots.end(), is_nearer);
}

void turn_inside_out(std::vector<MeshSpot>& spots) {
  for (MeshSpot& spot : spots) {
    spot.normal = -spot.normal;
    spot.distance_m = -spot.distance_m;
  }
}

void keep_distinct(std::vector<MeshSpot>& spots, double radius_m) {
  // Of the radius. Vertices in single precision (STL) make steps of 1e-6 of it in a flat face.
  constexpr double kFlat = 1e-4;
  std::sort(spots.begin(), spots.end(), is_nearer);
  std::size_t kept = 0;
  for (MeshSpot& spot : spots) {
    spot.overlap_m = radius_m - spot.distance_m;
    for (std::size_t k = 0; k < kept; ++k) {
      const double stands_out_m =
          (spots[k].to_centre_m - spot.to_centre_m).dot(spots[k].normal) - kFlat * radius_m;
      spot.overlap_m = std::min(spot.overlap_m, 0.5 * stands_out_m);
    }
    // Only the nearest spot is sure to know inside from outside; one that differs is seen from
    // behind.
    const bool agrees = kept == 0 || (spot.distance_m < 0) == (spots[0].distance_m < 0);
    if (agrees && spot.overlap_m > 0) spots[kept++] = spot;
  }
  spots.resize(kept);
}

}  // namespace hoof::sim
