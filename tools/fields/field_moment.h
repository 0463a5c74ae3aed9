// The sand near the foot and the foot in it, at one moment of a run.
#pragma once

#include <string>
#include <vector>

#include "sim/dem/byte_archive.h"
#include "sim/dem/sand_bed.h"
#include "sim/terrain/terrain.h"

namespace hoof::tools {

struct FieldMoment {
  std::string name;    // "contact", "after 20 ms", "greatest depth", "peak Fx", ...
  double time_s = 0;   // of the run
  double depth_m = 0;  // as the experiment means it
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();    // middle of the sole, world
  Eigen::Vector3d ground_N = Eigen::Vector3d::Zero();  // ground on foot, mean over the tick
  std::vector<sim::Pose> poses;                        // of the foot's bodies
  sim::BedState sand;                                  // within the recorded region
  std::vector<sim::MeshTouch> touches;                 // grains on the foot, forces on the grains
};

void put(sim::ByteWriter& out, const FieldMoment& moment);
/// @throws std::runtime_error where the bytes end too early
FieldMoment get_moment(sim::ByteReader& in);

}  // namespace hoof::tools
