// Durations that can be written down, both signs, one axis.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "firmware/trajectory/generator.h"

namespace hoof::firmware::trajectory {
namespace {

using Input1 = Input<double, 1>;

// Sums of a few products and one square root in double.
constexpr double kTolerance = 1e-12;

double duration_of(const Input1& input) {
  Generator<double, 1> generator(0.001);
  REQUIRE(generator.plan(input) == Result::kWorking);
  return generator.duration_s();
}

Input1 rest_to_rest(double distance, double v, double a, double j) {
  Input1 input;
  input.set_limits(0, v, a, j);
  input.position[0] = 0.3;
  input.target_position[0] = 0.3 + distance;
  return input;
}

TEST_CASE("rest to rest takes the textbook durations") {
  for (const double sign : {1.0, -1.0}) {
    CAPTURE(sign);
    // Jerk only: d = 2 J (T/4)^3.
    CHECK(duration_of(rest_to_rest(sign * 0.01, 5, 5, 10)) ==
          Approx(4 * std::cbrt(0.01 / 20)).epsilon(kTolerance));
    // Acceleration reached, velocity not: with t_j = a/J and t_a the hold, T = 4 t_j + 2 t_a and
    // d = a (t_j + t_a) (2 t_j + t_a).
    const double a = 2, j = 20, t_j = a / j, t_a = 0.25;
    CHECK(duration_of(rest_to_rest(sign * a * (t_j + t_a) * (2 * t_j + t_a), 5, a, j)) ==
          Approx(4 * t_j + 2 * t_a).epsilon(kTolerance));
    // All limits reached: T = d/v + v/a + a/J.
    CHECK(duration_of(rest_to_rest(sign * 7, 1.5, 2, 20)) ==
          Approx(7 / 1.5 + 1.5 / 2 + 0.1).epsilon(kTolerance));
  }
}

TEST_CASE("moving on at the velocity limit is a cruise") {
  for (const double sign : {1.0, -1.0}) {
    Input1 input = rest_to_rest(sign * 3, 2, 4, 30);
    input.velocity[0] = input.target_velocity[0] = sign * 2;
    CHECK(duration_of(input) == Approx(1.5).epsilon(kTolerance));
  }
}

TEST_CASE("asymmetric limits are not confused") {
  // Without a jerk limit: up at a_max for v/a_max, down at |a_min|.
  for (const bool mirrored : {false, true}) {
    Input1 input = rest_to_rest(mirrored ? -6 : 6, 2, 1, std::numeric_limits<double>::infinity());
    (mirrored ? input.min_acceleration[0] : input.max_acceleration[0]) = mirrored ? -4 : 4;
    const double up = 2.0 / 4, down = 2.0 / 1;
    const double cruise = (6 - 2 * (up + down) / 2) / 2;
    CHECK(duration_of(input) == Approx(up + cruise + down).epsilon(kTolerance));
  }
}

TEST_CASE("nothing to do takes no time, whatever the speed") {
  Input1 input = rest_to_rest(0, 2, 4, 30);
  CHECK(duration_of(input) == 0);
  input.velocity[0] = input.target_velocity[0] = -1.5;
  input.acceleration[0] = input.target_acceleration[0] = 0.5;
  CHECK(duration_of(input) == 0);
}

TEST_CASE("a blocked interval is jumped, not entered") {
  // Moving at 1 with a target 1 ahead at the same speed: 1 s, or far longer; asked for 1.02 s the
  // axis would have to lose 0.02 s, which with these small limits it cannot.
  Input1 input = rest_to_rest(1, 1, 0.05, 0.05);
  input.velocity[0] = input.target_velocity[0] = 1;
  input.acceleration[0] = input.target_acceleration[0] = 0;
  CHECK(duration_of(input) == Approx(1).epsilon(kTolerance));
  // Both accelerations upwards: the single ramp of no length is feasible, then there is a gap of
  // at least the 2 a0/J it takes to turn the acceleration round and back.
  Input1 gap = rest_to_rest(0, 2, 1, 1);
  gap.acceleration[0] = gap.target_acceleration[0] = 0.5;
  CHECK(duration_of(gap) == 0);
  gap.minimum_duration_s = 1e-3;
  CHECK(duration_of(gap) > 1);
}

TEST_CASE("a target that is only passed is taken in passing") {
  // In units with J = a_max = 1: ending with af = 0.9 at a low speed, the largest displacement
  // first grows with the duration (at dq/dtheta = 0.06), has a maximum some 3e-4 further, and falls
  // again while the acceleration is held. The shortest velocity change ends at the start of that
  // hill.
  for (const double sign : {1.0, -1.0}) {
    Input1 input = rest_to_rest(0, 2, 1, 1);
    input.velocity[0] = sign * -0.8;
    input.target_velocity[0] = sign * 0.105;
    input.target_acceleration[0] = sign * 0.9;
    Input1 change = input;
    change.interface = Interface::kVelocity;
    Generator<double, 1> generator(0.001);
    REQUIRE(generator.plan(change) == Result::kWorking);
    const double shortest_s = generator.duration_s();
    input.target_position[0] = generator.profile(0).end().position + sign * 1e-4;
    const double duration_s = duration_of(input);
    CHECK(duration_s > shortest_s);
    CHECK(duration_s < shortest_s + 1e-4 / 0.03);  // the mean growth up to there is above 0.03
    input.target_position[0] += sign * 1e-3;       // beyond the hill: far later
    CHECK(duration_of(input) > shortest_s + 0.1);
  }
}

TEST_CASE("the velocity interface ignores position and velocity limits") {
  for (const double sign : {1.0, -1.0}) {
    Input1 input = rest_to_rest(1, 0.1, 4, 20);
    input.interface = Interface::kVelocity;
    input.target_velocity[0] = sign * 3;
    // v / a + a / J with the acceleration limit reached.
    CHECK(duration_of(input) == Approx(3.0 / 4 + 4.0 / 20).epsilon(kTolerance));
    input.target_velocity[0] = sign * 0.2;  // not reached: 2 sqrt(v / J)
    CHECK(duration_of(input) == Approx(2 * std::sqrt(0.2 / 20)).epsilon(kTolerance));
  }
}

TEST_CASE("minimum and discrete durations") {
  Input1 input = rest_to_rest(7, 1.5, 2, 20);
  const double shortest_s = duration_of(input);
  input.minimum_duration_s = 9.25;
  CHECK(duration_of(input) == 9.25);
  input.minimum_duration_s = 1;
  CHECK(duration_of(input) == Approx(shortest_s).epsilon(kTolerance));
  input.duration_step_s = 0.01;
  CHECK(duration_of(input) == std::ceil(shortest_s / 0.01) * 0.01);
}

TEST_CASE("synchronisation modes") {
  Input<double, 2> input;
  input.set_limits(0, 1, 2, 20);
  input.set_limits(1, 3, 6, 60);
  input.target_position = {2, 0.5};
  Generator<double, 2> generator(0.001);
  input.synchronisation = Synchronisation::kNone;
  REQUIRE(generator.plan(input) == Result::kWorking);
  CHECK(generator.profile(1).duration_s() < generator.profile(0).duration_s());
  input.synchronisation = Synchronisation::kTime;
  REQUIRE(generator.plan(input) == Result::kWorking);
  CHECK(generator.profile(1).duration_s() == generator.profile(0).duration_s());
  Output<double, 2> output;
  input.synchronisation = Synchronisation::kPhase;
  REQUIRE(generator.plan(input) == Result::kWorking);
  for (double t = 0; t < generator.duration_s(); t += 0.01) {
    generator.at_time(t, output);
    REQUIRE(output.straight_line);
    REQUIRE(output.position[1] == Approx(output.position[0] / 4).margin(1e-12));
  }
}

TEST_CASE("a zero limit holds an axis or forbids the motion") {
  Input1 held = rest_to_rest(0, 0, 0, 0);
  CHECK(duration_of(held) == 0);
  Generator<double, 1> generator(0.001);
  CHECK(generator.plan(rest_to_rest(1, 1, 1, 0)) == Result::kZeroLimits);
  CHECK(generator.plan(rest_to_rest(1, 0, 1, 1)) == Result::kZeroLimits);
}

}  // namespace
}  // namespace hoof::firmware::trajectory
