// The angle of repose of a heap, by stated fits.
//
// The surface is the height of the highest grain over each point of a square grid of 1 mm. Two
// fits:
//  - ring: least squares of z = z0 - r tan(angle) over all points with r from 25 % to 85 % of the
//    heap's radius, r being the distance from the axis. Tip (flattened by the stream that falls on
//    it) and foot are left out.
//  - outline: as from a photograph. Seen from 18 sides, the outline is the highest point at each
//    distance u from the axis; a straight line through either flank over the same range of |u|; the
//    mean of both flanks and all sides. Of a cone both fits are the same; of a heap of few grains
//    the outline is that of the grains that stand out, and lies higher at the foot.
#pragma once

#include <vector>

#include "sim/dem/grain.h"

namespace hoof::tools {

struct HeapAngle {
  double ring_deg = 0;
  double outline_deg = 0;
  double sides_deg = 0;  // standard deviation of the ring fit over eight eighths of the heap
  double height_m = 0;   // of the highest point of the surface
  double radius_m = 0;   // to which the fits' ranges refer
  int grains_in_it = 0;
};

/// Of a heap on a plate: where the mean height of the surface around the axis falls below that.
/// @param floor_m height of a layer that is no heap: a grain
/// @throws std::invalid_argument where the surface is nowhere as high
double heap_radius_m(const std::vector<sim::Grain>& grains, double floor_m);

/// @param radius_m of the heap, which lies about the origin on z = 0: its dish's, or
/// heap_radius_m()
/// @throws std::invalid_argument where there is no heap to fit
HeapAngle heap_angle(const std::vector<sim::Grain>& grains, double radius_m);

}  // namespace hoof::tools
