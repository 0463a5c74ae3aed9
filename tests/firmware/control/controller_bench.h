// The foot controller on three plain joints: the gate and the bus left out.
#pragma once

#include <catch2/catch.hpp>

#include "firmware/control/foot_controller.h"
#include "tests/firmware/control/joint_plant.h"

namespace hoof::firmware::control::test {

struct ControllerBench {
  FootController controller;
  PerJoint<JointPlant> plants{};
  float toe_zero_rad = 0.0f;

  explicit ControllerBench(JointPresence presence = {}, const Settings& settings = {})
      : controller(settings, presence) {
    plants[0].stop_rad = 1.5;  // in the drive's own count
    plants[0].q_rad = 1.6;
    for (int i = 1; i < 3; ++i) {
      plants[i].inertia_kg_m2 = 0.5;
      plants[i].friction_Nm = 4.8;
      plants[i].torque_limit_Nm = 400.0;
    }
    plants[1].q_rad = 0.5;
    plants[2].q_rad = -1.4;
  }

  PerJoint<JointState> states() const {
    PerJoint<JointState> s{plants[0].state(), plants[1].state(), plants[2].state()};
    s[0].position_rad -= toe_zero_rad;
    return s;
  }

  void tick() {
    const Wish& wish = controller.step(states());
    for (std::size_t i = 0; i < kJointCount; ++i) {
      JointCommand c = wish.joint[i].command;
      if (wish.joint[i].action != DriveAction::kCommand) c = {};
      if (i == 0) c.position_rad += toe_zero_rad;
      plants[i].run(c);
    }
    if (const auto zero = controller.new_toe_zero_rad()) toe_zero_rad += *zero;
  }

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }

  /// @return ticks it took, or -1
  int run_until(Mode mode, int longest = 8000) {
    for (int i = 0; i < longest; ++i) {
      if (controller.mode() == mode) return i;
      tick();
    }
    return -1;
  }

  bool all(DriveAction action) const {
    for (const JointWish& joint : controller.wish().joint) {
      if (joint.action != action) return false;
    }
    return true;
  }
};

inline void bring_to(ControllerBench& bench, Mode mode) {
  if (mode == Mode::kOff) return;
  if (mode == Mode::kEmergencyOff) return bench.controller.emergency_stop();
  if (mode == Mode::kFault) return bench.controller.trip(fault::kDriveError);
  REQUIRE(bench.controller.order_run(0.3f, 1.0f) == Acceptance::kAccepted);
  const Mode first = mode == Mode::kDampedStop ? Mode::kRunning : mode;
  REQUIRE(bench.run_until(first) >= 0);
  if (mode == Mode::kReady) {
    REQUIRE(bench.controller.order_ready(0.3f) == Acceptance::kAccepted);
    bench.run(3000);
  }
  if (mode == Mode::kDampedStop) bench.controller.order_stop();
  REQUIRE(bench.controller.mode() == mode);
}

}  // namespace hoof::firmware::control::test
