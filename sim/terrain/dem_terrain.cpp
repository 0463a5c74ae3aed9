#include "sim/terrain/dem_terrain.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/dem/byte_archive.h"

namespace hoof::sim {

DemTerrain::DemTerrain(const DemSettings& settings, const BedState& state)
    : bed_(settings, state) {}

int DemTerrain::add_body(const TriangleMesh& mesh, const Pose& pose) {
  return bed_.add_mesh(mesh, pose.p_WB_m, pose.q_WB);
}

void DemTerrain::advance(double interval_s, std::span<const BodyMotion> motions,
                         std::span<Wrench> wrenches) {
  const double ratio = interval_s / bed_.settings().dt_s;
  const int steps = int(std::lround(ratio));
  if (steps < 1 || std::abs(ratio - steps) > 1e-6 * ratio) {
    throw std::invalid_argument("coupling.exchange_us = " + std::to_string(interval_s * 1e6) +
                                " is not a whole number of bed steps of " +
                                std::to_string(bed_.settings().dt_s * 1e6) +
                                " us; change bed.steps_per_ms");
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const BodyMotion& m = motions[i];
    Eigen::Quaterniond turn = m.end.q_WB * m.start.q_WB.conjugate();
    if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
    const Eigen::AngleAxisd rotation(turn);
    bed_.set_motion(int(i),
                    {m.start.p_WB_m, m.start.q_WB, (m.end.p_WB_m - m.start.p_WB_m) / interval_s,
                     rotation.angle() / interval_s * rotation.axis()});
  }
  bed_.advance(steps);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const MeshLoad load = bed_.take_load(int(i));
    wrenches[i] = {load.impulse_W_Ns / interval_s, load.angular_impulse_Bo_W_Nms / interval_s};
    work_J_ += load.work_J;
  }
}

// The bed's bytes, then the work: at the end, so that the bed's need not be copied.
std::string DemTerrain::snapshot() const {
  std::string bytes = bed_.snapshot();
  ByteWriter work;
  work.put(work_J_);
  return bytes += work.bytes();
}

void DemTerrain::restore(std::string_view snapshot) {
  if (snapshot.size() < sizeof work_J_) throw std::runtime_error("the snapshot is truncated");
  const std::size_t bed_bytes = snapshot.size() - sizeof work_J_;
  bed_.restore(snapshot.substr(0, bed_bytes));
  ByteReader(snapshot.substr(bed_bytes)).get(work_J_);
}

}  // namespace hoof::sim
