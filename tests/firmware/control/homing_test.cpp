#include "firmware/control/homing.h"

#include <catch2/catch.hpp>

#include "tests/firmware/control/joint_plant.h"

using namespace hoof::firmware::control;
using test::JointPlant;

namespace {

/// Runs until found or failed, or 10 s.
HomingResult home(Homing& homing, JointPlant& plant, int& ticks) {
  homing.start();
  JointCommand command;
  HomingResult result = HomingResult::kSeeking;
  for (ticks = 0; result == HomingResult::kSeeking && ticks < 10000; ++ticks) {
    result = homing.step(plant.state(), command);
    plant.run(command);
  }
  return result;
}

}  // namespace

TEST_CASE("The closed stop is found from anywhere, with any zero of the drive") {
  for (const double start_rad : {0.0, 0.2, 0.7}) {
    for (const double drive_zero_rad : {-2.0, 0.0, 5.5}) {
      Homing homing({}, kTick_s);
      JointPlant plant;
      plant.stop_rad = drive_zero_rad;
      plant.q_rad = drive_zero_rad + start_rad;
      int ticks = 0;
      REQUIRE(home(homing, plant, ticks) == HomingResult::kFound);
      // The stop gives way by 1.2 Nm / 5000 Nm/rad, and by what friction keeps of the impact.
      CHECK(homing.zero_rad() == Approx(drive_zero_rad).margin(3.5e-4));
      // Damping alone against friction: 0.5 rad/s less (0.48 + 0.024 * 0.3) / 2.4.
      CHECK(ticks == Approx(start_rad / 0.297 * 1000.0 + 70.0).margin(60.0));
    }
  }
}

TEST_CASE("The push at the stop is speed times damping") {
  Homing homing({}, kTick_s);
  JointPlant plant;
  plant.stop_rad = 0.0;
  plant.q_rad = 0.05;
  int ticks = 0;
  REQUIRE(home(homing, plant, ticks) == HomingResult::kFound);
  CHECK(plant.motor_Nm == Approx(-1.2).margin(0.05));
}

TEST_CASE("An angle at the stop other than zero is taken off") {
  HomingSettings settings;
  settings.stop_angle_rad = -0.03f;
  Homing homing(settings, kTick_s);
  JointPlant plant;
  plant.stop_rad = 1.0;
  plant.q_rad = 1.1;
  int ticks = 0;
  REQUIRE(home(homing, plant, ticks) == HomingResult::kFound);
  CHECK(homing.zero_rad() == Approx(1.03).margin(3.5e-4));
}

TEST_CASE("Without a stop the search fails after its time") {
  Homing homing({}, kTick_s);
  JointPlant plant;
  int ticks = 0;
  CHECK(home(homing, plant, ticks) == HomingResult::kFailed);
  CHECK(ticks == Approx(5000).margin(2));
}

TEST_CASE("An obstacle pushing against the opening side is not the stop") {
  Homing homing({}, kTick_s);
  homing.start();
  JointState state;
  state.torque_Nm = 1.2f;  // standing still, but pushing outward
  JointCommand command;
  for (int i = 0; i < 1000; ++i) REQUIRE(homing.step(state, command) == HomingResult::kSeeking);
}
