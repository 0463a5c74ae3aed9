// Everything the loop knew and decided in its last tick, for recorders in the same process and as
// the source of the telemetry frames.
#pragma once

#include <cstdint>

#include "firmware/app/counters.h"
#include "firmware/control/foot_controller.h"
#include "firmware/safety/torque_gate.h"

namespace hoof::firmware::app {

struct Telemetry {
  std::uint32_t tick = 0;  // number of the SYNC
  std::int64_t time_ns = 0;
  control::Mode mode = control::Mode::kOff;
  control::FaultBits faults = 0;
  control::PerJoint<control::JointState> state{};
  control::Wish wish;
  safety::Verdict verdict;

  bool homed = false;
  float toe_target_rad = 0.0f;     // ordered
  float toe_set_point_rad = 0.0f;  // of the move under way
  bool toe_moving = false;
  control::LegAngles leg_set_point_rad;
  control::PlaneVector foot_m;            // measured sole point from the hip
  control::PlaneVector foot_set_point_m;  // commanded sole point from the hip
  float foot_pitch_rad = 0.0f;            // measured, front up +
  float phase_cycles = 0.0f;              // place on the stance path; 0.75 is its top
  float gait_rate_Hz = 0.0f;
  control::GroundEstimate ground;

  control::PerJoint<float> heat_ratio{};  // winding's heat over what it bears for ever
  float supply_V = 0.0f;                  // 0 where the board does not measure it
  std::uint32_t gate_interventions = 0;
  Counters counters;
};

}  // namespace hoof::firmware::app
