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
  for (std::size_t i = 0; i < spots.size(); ++i) {
    MeshSpot& spot = spots[i];
    spot.overlap_m = radius_m - spot.distance_m;
    for (std::size_t k = 0; k < i; ++k) {
      const MeshSpot& nearer = spots[k];
      const double stands_out_m =
          (nearer.to_centre_m - spot.to_centre_m).dot(nearer.normal) - kFlat * radius_m;
      if (nearer.overlap_m > 0) {
        spot.overlap_m = std::min(spot.overlap_m, 0.5 * stands_out_m);
      } else if (spot.on_border && stands_out_m <= 0) {
        spot.overlap_m = 0;  // it may belong to a neighbour that comes nearer elsewhere
      }
    }
    // Only the nearest spot is sure to know inside from outside; one that differs is seen from
    // behind.
    if ((spot.distance_m < 0) != (spots[0].distance_m < 0)) spot.overlap_m = 0;
  }
  std::erase_if(spots, [](const MeshSpot& spot) { return spot.overlap_m <= 0; });
}

}  // namespace hoof::sim
