// Starts outside the limits: what the brake does first, in both directions.
#include "firmware/trajectory/brake.h"

#include <catch2/catch.hpp>

#include "firmware/trajectory/profile.h"

namespace hoof::firmware::trajectory {
namespace {

constexpr AxisLimits<double> kLimits{2, -2, 4, -4, 20};
constexpr double kTolerance = 1e-12;  // a few products

State<double> after(const Brake<double>& brake, double v, double a) {
  State<double> state{0, v, a};
  for (int i = 0; i < brake.count; ++i) {
    state.acceleration = brake.phase[i].acceleration;
    state = Profile<double>::advanced(state, brake.phase[i].jerk, brake.phase[i].duration_s);
  }
  return state;
}

TEST_CASE("inside the limits there is nothing to brake") {
  CHECK(position_brake(2.0, 0.0, kLimits).count == 0);
  CHECK(position_brake(-2.0, 0.0, kLimits).count == 0);
  CHECK(position_brake(1.6, 4.0, kLimits).count == 0);  // 1.6 + 4^2 / 40 = 2, the last moment
}

TEST_CASE("acceleration beyond its bound goes there at full jerk") {
  for (const double sign : {1.0, -1.0}) {
    const Brake<double> brake = position_brake(-sign * 0.5, sign * 6.0, kLimits);
    CHECK(brake.total_s() == Approx(0.1).epsilon(kTolerance));
    CHECK(after(brake, -sign * 0.5, sign * 6.0).acceleration == Approx(sign * 4));
  }
}

TEST_CASE("velocity beyond its bound, or bound to be, is pulled back") {
  for (const double sign : {1.0, -1.0}) {
    // 3 -> 2 at -4: ramp of 0.2 s loses 0.4, hold loses the other 0.6 in 0.15 s.
    Brake<double> brake = position_brake(sign * 3.0, 0.0, kLimits);
    CHECK(brake.total_s() == Approx(0.35).epsilon(kTolerance));
    CHECK(after(brake, sign * 3.0, 0).velocity == Approx(sign * 2).epsilon(kTolerance));
    // 1.9 with 4: would reach 2.3.
    brake = position_brake(sign * 1.9, sign * 4.0, kLimits);
    CHECK(brake.count > 0);
    CHECK(after(brake, sign * 1.9, sign * 4.0).velocity == Approx(sign * 2).epsilon(kTolerance));
  }
}

TEST_CASE("without a jerk limit the brake is one phase") {
  const Brake<double> brake = unlimited_jerk_brake(3.0, kLimits);
  CHECK(brake.total_s() == Approx(0.25).epsilon(kTolerance));
  CHECK(unlimited_jerk_brake(-3.0, kLimits).total_s() == Approx(0.25).epsilon(kTolerance));
}

}  // namespace
}  // namespace hoof::firmware::trajectory
