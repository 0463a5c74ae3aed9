// What the default path with the paper's stance forces asks of the joints, against the gate's
// ceilings: no limit may clip the traction tests unsaid.
#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/control/leg_motion.h"
#include "firmware/safety/limits.h"

using namespace hoof::firmware;
using namespace hoof::firmware::control;

namespace {

struct Stance {
  float frequency_Hz;
  float fx_N, fz_N;    // at the peak of the traction force; source paper, traction test, 0 degrees
  double hip_peak_Nm;  // data page of the paper: static, at the deepest point
};

/// The paper gives the forces at one instant only. Scaled with the depth they make a whole stance.
constexpr Stance kStances[] = {{0.45f, 259.87f, 406.76f, 139.0},
                               {0.45f, 259.58f, 599.25f, 139.0},
                               {1.12f, 431.20f, 664.15f, 235.0},
                               {1.12f, 442.12f, 1075.29f, 235.0}};

struct Demand {
  double torque_Nm = 0.0;
  double torque_step_Nm = 0.0;  // from tick to tick
  double speed_rad_s = 0.0;
  double deflection_rad = 0.0;  // of the joint from its target: what is not fed forward
  double lowest_rad = 1e9, highest_rad = -1e9;
};

/// Two cycles after the ramp; hip and knee.
std::array<Demand, 2> demand_of(const Stance& stance) {
  const Settings settings;
  LegMotion leg(settings, kTick_s);
  leg.start({0.562f, -1.42f});
  leg.go_to_path();
  for (int i = 0; i < 4000 && !leg.on_path(); ++i) leg.step();
  REQUIRE(leg.on_path());
  leg.set_frequency(stance.frequency_Hz);
  const int ramp = int(400.0f / stance.frequency_Hz), cycles = int(2000.0f / stance.frequency_Hz);
  std::array<Demand, 2> demand;
  double last_Nm[2] = {};
  for (int i = 0; i < ramp + cycles; ++i) {
    const LegCommand command = leg.step();
    const LegAngles q = leg.set_point_rad();
    const double depth_m = -(leg.kinematics().foot_m(q).z + settings.path.hip_above_sand_m);
    const float share = depth_m > 0.0 ? float(depth_m / 0.035) : 0.0f;
    const LegAngles sand =
        leg.kinematics().joint_torque_Nm(q, {share * stance.fx_N, share * stance.fz_N});
    const JointCommand joints[] = {command.hip, command.knee};
    const float load_Nm[] = {sand.hip_rad, sand.knee_rad};
    for (int j = 0; j < 2; ++j) {
      Demand& d = demand[j];
      const double torque_Nm = double(joints[j].torque_Nm) - load_Nm[j];
      if (i > ramp) {
        d.torque_step_Nm = std::max(d.torque_step_Nm, std::abs(torque_Nm - last_Nm[j]));
      }
      last_Nm[j] = torque_Nm;
      d.torque_Nm = std::max(d.torque_Nm, std::abs(torque_Nm));
      d.speed_rad_s = std::max(d.speed_rad_s, std::abs(double(joints[j].velocity_rad_s)));
      const double away_rad = load_Nm[j] / settings.leg.kp_Nm_rad;
      d.deflection_rad = std::max(d.deflection_rad, std::abs(away_rad));
      d.lowest_rad = std::min(d.lowest_rad, joints[j].position_rad - std::abs(away_rad));
      d.highest_rad = std::max(d.highest_rad, joints[j].position_rad + std::abs(away_rad));
    }
  }
  return demand;
}

}  // namespace

TEST_CASE("The paper's traction tests stay below every ceiling of the gate") {
  for (const Stance& stance : kStances) {
    const std::array<Demand, 2> demand = demand_of(stance);
    for (int j = 0; j < 2; ++j) {
      const Demand& d = demand[j];
      const safety::JointLimits& limit = safety::kLimits[std::size_t(j) + 1];
      CAPTURE(stance.frequency_Hz, stance.fz_N, j, d.torque_Nm, d.torque_step_Nm, d.speed_rad_s,
              d.deflection_rad, d.lowest_rad, d.highest_rad);
      CHECK(d.torque_Nm < limit.torque_Nm);
      CHECK(d.torque_step_Nm < limit.torque_rate_Nm_s * kTick_s);
      CHECK(d.speed_rad_s < limit.velocity_rad_s);
      CHECK(d.deflection_rad < limit.distance_rad);
      CHECK(d.lowest_rad > limit.lower_rad);
      CHECK(d.highest_rad < limit.upper_rad);
      CHECK(LegSettings{}.kp_Nm_rad <= limit.kp_Nm_rad);
      CHECK(LegSettings{}.kd_Nm_s_rad <= limit.kd_Nm_s_rad);
    }
  }
}

TEST_CASE("The demand itself is the data page's: torque and speed of the hip, within a tenth") {
  for (const Stance& stance : kStances) {
    const LegMotion leg(Settings{}, kTick_s);
    const LegAngles deepest = leg.kinematics().angles(leg.path().deepest_m()).angles;
    const LegAngles sand = leg.kinematics().joint_torque_Nm(deepest, {stance.fx_N, stance.fz_N});
    CHECK(sand.hip_rad == Approx(stance.hip_peak_Nm).epsilon(0.03));
    const std::array<Demand, 2> demand = demand_of(stance);
    const double fastest = std::max(demand[0].speed_rad_s, demand[1].speed_rad_s);
    CHECK(fastest == Approx(stance.frequency_Hz < 1.0f ? 0.73 : 1.82).epsilon(0.02));
    // The rest is gravity, inertia and friction, some of which helps.
    CHECK(demand[0].torque_Nm > 0.9 * stance.hip_peak_Nm);
  }
}
