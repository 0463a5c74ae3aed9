#include "tools/terrain/push_sand.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

/// Whole bed steps of one interval of a leg.
int steps_of(const PushLeg& leg, double dt_s, double speed_m_s) {
  return std::max(1, int(std::lround(leg.way_m.norm() / leg.intervals / speed_m_s / dt_s)));
}

}  // namespace

void require_room(const PushCase& plate, const sim::BedSettings& bed) {
  const Eigen::Vector2d half = plate.half_extent_m();
  const Eigen::Vector2d room(0.5 * bed.box_length_m - half.x(), 0.5 * bed.box_width_m - half.y());
  const double depth_m = bed.depth_m - plate.insert_m - plate.way_m * std::sin(plate.gamma_rad);
  // A wall nearer than half a width shows in the force (sim/experiments/RESOLUTION.md).
  const double least_m = 0.5 * plate.smaller_width_m();
  const double have_m = std::min(room.minCoeff(), depth_m);
  if (have_m >= least_m) return;
  char text[240];
  std::snprintf(text, sizeof text,
                "%s: %.1f mm from a wall or the floor of the bed '%s', must be at least %.1f mm; "
                "make the plates smaller (--scale) or the box larger",
                plate.name.c_str(), have_m * 1e3, bed.name.c_str(), least_m * 1e3);
  throw std::invalid_argument(text);
}

double push_steps(const PushCase& plate, const sim::BedSettings& bed, double speed_m_s) {
  double steps = 0;
  for (const PushLeg& leg : legs_of(plate)) {
    steps += leg.intervals * double(steps_of(leg, bed.step_s(), speed_m_s));
  }
  return steps;
}

std::string push_key(const PushCase& plate, const std::string& bed_key, double speed_m_s) {
  std::string key = bed_key;
  for (const double value : {plate.length_m, plate.width_m, plate.thickness_m, plate.beta_rad,
                             plate.psi_rad, plate.gamma_rad, plate.insert_m, plate.way_m,
                             plate.back_m, double(plate.held_out), speed_m_s}) {
    key += " " + format_number(value);
  }
  return key;
}

Push push_in_sand(const PushCase& plate, const sim::BedSettings& bed,
                  const sim::Materials& materials, const sim::BedState& state, double speed_m_s,
                  int threads, const sim::BedProgress& progress) {
  require_room(plate, bed);
  sim::SandBed sand(sim::dem_settings(bed, materials, threads), state);
  sim::MeshMotion motion;
  motion.p_WB_m = plate.start_m();
  motion.q_WB = plate.q_WB();
  const int mesh = sand.add_mesh(plate.mesh(), motion.p_WB_m, motion.q_WB);
  const double dt_s = sand.settings().dt_s;
  const double all = push_steps(plate, bed, speed_m_s);
  Push push{plate, {}};
  double done = 0;
  for (const PushLeg& leg : legs_of(plate)) {
    const int steps = steps_of(leg, dt_s, speed_m_s);
    const Eigen::Vector3d interval_m = leg.way_m / leg.intervals;
    motion.v_WB_m_s = interval_m / (steps * dt_s);
    for (int i = 0; i < leg.intervals; ++i) {
      sand.set_motion(mesh, motion);
      sand.advance(steps);
      motion.p_WB_m += interval_m;
      const Eigen::Vector3d force_N = sand.take_load(mesh).impulse_W_Ns / (steps * dt_s);
      if (leg.phase != PushPhase::kInsert) {
        push.samples.push_back({leg.phase, (i + 0.5) * interval_m.norm(), force_N});
      }
      done += steps;
      if (progress && !progress(done / all)) throw std::runtime_error("stopped");
    }
  }
  return push;
}

}  // namespace hoof::tools
