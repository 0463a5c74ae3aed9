#include "firmware/control/leg_motion.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace hoof::firmware::control;

namespace {

constexpr LegAngles kAnyPosture{0.3f, -1.8f};

struct Walk {
  LegMotion leg;
  LegCommand command;

  explicit Walk(const Settings& settings = {}) : leg(settings, kTick_s) { leg.start(kAnyPosture); }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) command = leg.step();
  }
};

}  // namespace

TEST_CASE("A started leg holds the measured posture against gravity") {
  Walk walk;
  walk.run(100);
  CHECK(walk.command.hip.position_rad == kAnyPosture.hip_rad);
  CHECK(walk.command.knee.position_rad == kAnyPosture.knee_rad);
  CHECK(walk.command.hip.velocity_rad_s == 0.0f);
  const LegAngles gravity = walk.leg.dynamics().torque_Nm(kAnyPosture, {}, {});
  CHECK(walk.command.hip.torque_Nm == gravity.hip_rad);
  CHECK(walk.command.knee.torque_Nm == gravity.knee_rad);
  CHECK_FALSE(walk.leg.on_path());
}

TEST_CASE("The leg's move is planned over some ticks, in which it holds its posture") {
  Walk walk;
  walk.leg.go_to_path();
  int waited = 0;
  for (walk.run(1); waited < 50 && walk.command.hip.velocity_rad_s == 0.0f; walk.run(1)) {
    CHECK(walk.command.hip.position_rad == kAnyPosture.hip_rad);
    CHECK_FALSE(walk.leg.on_path());
    ++waited;
  }
  using Planner = hoof::firmware::trajectory::Planner<float, 2>;
  const int units = Planner::usual_units(2, hoof::firmware::trajectory::Synchronisation::kTime);
  CHECK(waited >= units / kPlanningUnitsPerTick - 1);
  CHECK(waited <= units / kPlanningUnitsPerTick + 1);
}

TEST_CASE("Both joints arrive together at the top of the path, within the limits") {
  Walk walk;
  walk.leg.go_to_path();
  LegAngles previous = kAnyPosture;
  int ticks = 0;
  int hip_arrived = 0, knee_arrived = 0;
  while (!walk.leg.on_path() && ticks < 10000) {
    walk.run(1);
    ++ticks;
    const LegAngles now = walk.leg.set_point_rad();
    REQUIRE(std::abs(now.hip_rad - previous.hip_rad) <= 1.001e-3f);
    REQUIRE(std::abs(now.knee_rad - previous.knee_rad) <= 1.001e-3f);
    if (now.hip_rad != previous.hip_rad) hip_arrived = ticks;
    if (now.knee_rad != previous.knee_rad) knee_arrived = ticks;
    previous = now;
  }
  CHECK(ticks < 3000);
  // The last microradians are below the digits of a float.
  CHECK(hip_arrived == Approx(knee_arrived).margin(30));
  const PlaneVector foot = walk.leg.kinematics().foot_m(walk.leg.set_point_rad());
  CHECK(foot.x == Approx(0.0).margin(1e-6));
  CHECK(foot.z == Approx(-0.455).margin(1e-6));
  CHECK(walk.leg.reachable());
}

TEST_CASE(
    "On the path the commanded postures put the foot on the ellipse, at the commanded speed") {
  Walk walk;
  walk.leg.go_to_path();
  walk.run(3000);
  REQUIRE(walk.leg.on_path());
  walk.leg.set_frequency(1.12f);
  LegAngles previous = walk.leg.set_point_rad();
  float peak_rad_s = 0.0f, lowest_m = 0.0f, up_rad = 0.0f, down_rad = 0.0f;
  for (int i = 0; i < 3000; ++i) {
    walk.run(1);
    const PlaneVector foot = walk.leg.kinematics().foot_m(walk.leg.set_point_rad());
    const double x = foot.x / 0.10, z = (foot.z + 0.495) / 0.04;
    REQUIRE(x * x + z * z == Approx(1.0).margin(3e-5));
    const LegAngles now = walk.leg.set_point_rad();
    // Difference over a tick against the speed at its end: half a tick of acceleration (25 rad/s2).
    REQUIRE(walk.command.hip.velocity_rad_s ==
            Approx((now.hip_rad - previous.hip_rad) / kTick_s).margin(0.02));
    REQUIRE(walk.command.knee.velocity_rad_s ==
            Approx((now.knee_rad - previous.knee_rad) / kTick_s).margin(0.02));
    previous = now;
    lowest_m = std::min(lowest_m, foot.z + 0.5f);
    if (foot.z < -0.5f) {
      const float pitch_rad = walk.leg.foot_pitch_rad(now);
      up_rad = std::max(up_rad, pitch_rad);
      down_rad = std::min(down_rad, pitch_rad);
      peak_rad_s = std::max({peak_rad_s, std::abs(walk.command.hip.velocity_rad_s),
                             std::abs(walk.command.knee.velocity_rad_s)});
    }
  }
  CHECK(lowest_m == Approx(-0.035).margin(1e-5));
  // Data page: pitch -16 to +7 degrees in stance.
  CHECK(up_rad == Approx(0.122).margin(0.01));
  CHECK(down_rad == Approx(-0.279).margin(0.01));
  CHECK(peak_rad_s > 0.8f);
  CHECK(peak_rad_s < 1.9f);  // data page: 1.82 rad/s at 1.12 Hz over the whole cycle
}

TEST_CASE("A path that the leg cannot reach is noticed") {
  Settings settings;
  settings.path.semi_x_m = 0.5f;
  Walk walk(settings);
  walk.leg.go_to_path();
  walk.run(3000);
  REQUIRE(walk.leg.reachable());  // its top is within reach
  walk.leg.set_frequency(1.0f);
  walk.run(1000);
  CHECK_FALSE(walk.leg.reachable());
}
