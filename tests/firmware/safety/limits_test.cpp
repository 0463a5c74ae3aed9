// Each compiled ceiling once more, as a number. A changed ceiling must be changed here, too, by
// somebody who means it.
#include "firmware/safety/limits.h"

#include <catch2/catch.hpp>

#include "firmware/safety/supply.h"
#include "firmware/safety/torque_gate.h"

using namespace hoof::firmware::safety;

namespace {

void check(const JointLimits& limits, const JointLimits& expected) {
  CHECK(limits.torque_Nm == expected.torque_Nm);
  CHECK(limits.torque_rate_Nm_s == expected.torque_rate_Nm_s);
  CHECK(limits.feed_forward_Nm == expected.feed_forward_Nm);
  CHECK(limits.distance_rad == expected.distance_rad);
  CHECK(limits.lower_rad == expected.lower_rad);
  CHECK(limits.upper_rad == expected.upper_rad);
  CHECK(limits.velocity_rad_s == expected.velocity_rad_s);
  CHECK(limits.kp_Nm_rad == expected.kp_Nm_rad);
  CHECK(limits.kd_Nm_s_rad == expected.kd_Nm_s_rad);
  CHECK(limits.plausible_rad_s == expected.plausible_rad_s);
  CHECK(limits.end_of_range_rad == expected.end_of_range_rad);
  CHECK(limits.drift_rad == expected.drift_rad);
  CHECK(limits.following_Nm == expected.following_Nm);
  CHECK(limits.stuck_Nm == expected.stuck_Nm);
  CHECK(limits.stop_kd_Nm_s_rad == expected.stop_kd_Nm_s_rad);
}

void check(const DriveData& drive, const DriveData& expected) {
  CHECK(drive.peak_torque_Nm == expected.peak_torque_Nm);
  CHECK(drive.continuous_torque_Nm == expected.continuous_torque_Nm);
  CHECK(drive.copper_loss_W_Nm2 == expected.copper_loss_W_Nm2);
  CHECK(drive.thermal_resistance_K_W == expected.thermal_resistance_K_W);
  CHECK(drive.heat_capacity_J_K == expected.heat_capacity_J_K);
}

}  // namespace

TEST_CASE("The ceilings are those that were decided") {
  check(kLimits[0], {10, 3000, 24, 0.125f, -0.1f, 1, 10, 500, 5, 45, 12.49f, 0.03f, 2.5f, 4, 2.4f});
  const JointLimits hip{317, 100e3f, 400,   0.1f,  -1.2f, 1.6f, 5,  20e3f,
                        500, 20,     3.19f, 0.02f, 80,    30,   200};
  check(kLimits[1], hip);
  JointLimits knee = hip;
  knee.lower_rad = -2.7f;
  knee.upper_rad = 0.05f;
  check(kLimits[2], knee);
  CHECK(kTravelMargin_rad == 0.05f);
  CHECK(kHighestTemperature_C == 100.0f);
  CHECK(kWarm == 0.9f);
  CHECK(kOverheated == 1.1f);
  CHECK(kDriftMemory_s == 0.1f);
  CHECK(kLongestGap_ticks == 20);
  CHECK(kNotFollowingTicks == 100);
  CHECK(kStuckReplies == 10);
  CHECK(kSettlingReplies == 4);
  CHECK(kFreshness_ns == 20'000'000);
  CHECK(kLowestSupply_V == 36.0f);
}

TEST_CASE("The drives are those that were chosen") {
  check(kDrives[0], {18, 9, 0.19f, 3, 100});
  check(kDrives[1], {317, 268, 0.0006f, 1.5f, 600});
  check(kDrives[2], {317, 268, 0.0006f, 1.5f, 600});
  CHECK(kToeDrive.thermal_time_s() == 300.0f);
  CHECK(kLegDrive.thermal_time_s() == 900.0f);
  CHECK(kToeDrive.rise_K(9.0f) == Approx(46.17));  // 3 * 0.19 * 81
  CHECK(kLegDrive.rise_K(-268.0f) == Approx(64.6416));
}

TEST_CASE("No limit clips the paper's traction, for ever") {
  const float paper_Nm = 235.0f;  // peak of the stance at 1.12 Hz
  for (const std::size_t joint : {1, 2}) {
    CHECK(kLimits[joint].torque_Nm > paper_Nm);
    CHECK(kDrives[joint].continuous_torque_Nm > paper_Nm);
  }
}

TEST_CASE("A ceiling fits its drive: not above its peak, above what it bears, within the rate") {
  const auto fits = [](float torque_Nm, float rate_Nm_s) {
    JointLimits limits = kLimits[0];
    limits.torque_Nm = torque_Nm;
    limits.torque_rate_Nm_s = rate_Nm_s;
    return ceiling_fits(limits, kToeDrive);  // 18 Nm peak, 9 Nm for ever
  };
  CHECK(fits(18.0f, 10e3f));
  CHECK_FALSE(fits(18.01f, 10e3f));
  CHECK_FALSE(fits(9.0f, 10e3f));
  CHECK(fits(9.01f, 10e3f));
  CHECK(fits(13.0f, 4000.0f));  // 4 Nm a tick, to the last bit
  CHECK_FALSE(fits(13.0f, 3999.0f));
  for (std::size_t joint = 0; joint < 3; ++joint) {
    CHECK(ceiling_fits(kLimits[joint], kDrives[joint]));
  }
}

TEST_CASE("Each limit is a bit of its own, in the order of the wire") {
  const LimitBits bits[] = {limit::kTorque,  limit::kTorqueRate, limit::kDistance,
                            limit::kTravel,  limit::kVelocity,   limit::kGain,
                            limit::kRefused, limit::kLatched,    limit::kOverload};
  for (std::size_t i = 0; i < std::size(bits); ++i) CHECK(bits[i] == 1u << i);
}
