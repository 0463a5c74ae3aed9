// What a caller hands to the generator and what it gets back. Units: any consistent set (rad or m,
// and s); nothing here depends on it. Limits are per joint, maxima >= 0 and minima <= 0.
#pragma once

#include <array>

#include "firmware/trajectory/result.h"

namespace hoof::firmware::trajectory {

template <typename Real, int kMaxJoints>
struct Input {
  using Vector = std::array<Real, kMaxJoints>;

  int joints = kMaxJoints;
  Interface interface = Interface::kPosition;
  Synchronisation synchronisation = Synchronisation::kTime;

  // Start state. Read by the first update() after construction or reset(); from then on a new plan
  // starts at the commanded state the generator itself keeps.
  Vector position{};
  Vector velocity{};
  Vector acceleration{};

  Vector target_position{};  // not read with Interface::kVelocity
  Vector target_velocity{};
  Vector target_acceleration{};

  Vector max_velocity{};
  Vector min_velocity{};
  Vector max_acceleration{};
  Vector min_acceleration{};
  Vector max_jerk{};  // infinity: no jerk limit, the acceleration may jump

  Real minimum_duration_s = 0;  // the plan takes at least this long
  Real duration_step_s = 0;     // > 0: the duration is a multiple of this; 0: continuous

  // Symmetric limits for one joint.
  void set_limits(int joint, Real velocity_limit, Real acceleration_limit, Real jerk_limit) {
    max_velocity[joint] = velocity_limit;
    min_velocity[joint] = -velocity_limit;
    max_acceleration[joint] = acceleration_limit;
    min_acceleration[joint] = -acceleration_limit;
    max_jerk[joint] = jerk_limit;
  }
};

template <typename Real, int kMaxJoints>
struct Output {
  using Vector = std::array<Real, kMaxJoints>;

  Vector position{};
  Vector velocity{};
  Vector acceleration{};
  Vector jerk{};  // of the piece the sample lies on; 0 where the jerk is unlimited

  Real time_s = 0;             // since the start of the running profile
  Real duration_s = 0;         // of the running profile
  bool new_plan = false;       // this tick is the first of a new profile
  bool stopping = false;       // the running profile is the fallback stop
  bool straight_line = false;  // phase synchronised
  Result plan_result{};        // of the latest plan: a failure stays here while stopping
};

}  // namespace hoof::firmware::trajectory
