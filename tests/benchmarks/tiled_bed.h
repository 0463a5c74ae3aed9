// Large beds for benchmarks: one settled periodic bed, repeated.
#pragma once

#include <string>

#include "sim/dem/sand_bed.h"

namespace hoof::benchmarks {

/// A bed that repeats along x and y, floor z = 0, and its period.
struct PeriodicBed {
  hoof::sim::BedState state;
  double period_x_m = 0;
  double period_y_m = 0;
  double surface_m = 0;  // top of the highest grain
};

/// Reads columns d,x,y,z,vx,vy,vz,wx,wy,wz (SI). @throws std::runtime_error naming file and line
PeriodicBed read_periodic_bed(const std::string& file, double period_x_m, double period_y_m);

/// nx times ny copies side by side, contact histories included.
PeriodicBed tiled(const PeriodicBed& tile, int nx, int ny);

/// The paper's sand on such a bed: gravity, all friction, floor.
hoof::sim::DemSettings settings_for(const PeriodicBed& bed, hoof::sim::Precision precision,
                                    int threads);

}  // namespace hoof::benchmarks
