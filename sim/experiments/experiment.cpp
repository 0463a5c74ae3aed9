#include "sim/experiments/experiment.h"

namespace hoof::sim {

const char* to_string(Phase phase) {
  switch (phase) {
    case Phase::kPreparing:
      return "preparing";
    case Phase::kLowering:
      return "lowering";
    case Phase::kLoaded:
      return "loaded";
    case Phase::kFinished:
      return "finished";
  }
  return "?";
}

void Experiment::advance() {
  before_interval();
  plant_->advance();
  ground_sum_N_ += plant_->ground_force_N();
  ++intervals_;
  after_interval();
}

Observation Experiment::observe() {
  const Rig& rig = plant_->rig();
  Observation o;
  o.time_s = plant_->time_s();
  o.phase = phase_;
  o.depth_m = depth_m();
  o.sink_speed_m_s = -rig.foot_velocity_m_s().z();
  o.foot_m = rig.foot_position_m();
  if (intervals_ > 0) o.ground_N = ground_sum_N_ / intervals_;
  if (rig.body_count() == 3) {
    o.toe_left_rad = rig.toe_opening_rad(0);
    o.toe_right_rad = rig.toe_opening_rad(1);
  }
  ground_sum_N_.setZero();
  intervals_ = 0;
  return o;
}

}  // namespace hoof::sim
