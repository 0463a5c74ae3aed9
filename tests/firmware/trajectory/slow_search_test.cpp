// The judge of optimality, on durations known in closed form and on plans that are not optimal.
#include "tools/trajectory/slow_search.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "tools/trajectory/referee.h"

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;

AxisProblem rest_to_rest(double distance, double v, double a, double j) {
  return {distance, 0, 0, 0, 0, {v, -v, a, -a, j}};
}

TEST_CASE("durations of a move from rest to rest") {
  for (const double sign : {1.0, -1.0}) {
    const double shortest_s = 4 * std::cbrt(0.01 / 20);
    const auto set = slow_durations(rest_to_rest(sign * 0.01, 5, 5, 10), 3, {});
    REQUIRE(set.size() == 1);
    CHECK(set[0].from_s == Approx(shortest_s).epsilon(1e-9));
    CHECK(set[0].to_s == 3);
  }
}

TEST_CASE("a lone duration and the gap behind it") {
  // Both accelerations upwards: one ramp of nothing, or round and back.
  AxisProblem axis = rest_to_rest(0, 2, 1, 1);
  axis.acceleration = axis.target_acceleration = 0.5;
  const auto set = slow_durations(axis, 10, {});
  REQUIRE(set.size() == 2);
  CHECK(set[0].from_s == 0);
  CHECK(set[0].to_s < 1e-3);
  CHECK(set[1].from_s > 1);
}

TEST_CASE("only velocities: three closed forms") {
  AxisProblem axis = rest_to_rest(123, 2, 1, 1);
  axis.target_velocity = 0.25;  // two ramps: 2 sqrt(dv / j)
  SlowSearch search;
  search.velocity_only = true;
  CHECK(slow_durations(axis, 10, search).at(0).from_s == Approx(1.0).epsilon(1e-9));
  axis.target_velocity = 1.75;  // with a hold at a_max: dv / a + a / j
  CHECK(slow_durations(axis, 10, search).at(0).from_s == Approx(2.75).epsilon(1e-9));
  axis.target_velocity = -1.75;
  CHECK(slow_durations(axis, 10, search).at(0).from_s == Approx(2.75).epsilon(1e-9));
}

TEST_CASE("first common durations") {
  const std::vector<Durations> a{{1, 2}, {5, 9}};
  const std::vector<Durations> b{{1.5, 1.6}, {2.5, 9}};
  CHECK(*first_common({a, b}, 0, 0) == 1.5);
  CHECK(*first_common({a, b}, 1.7, 0) == 5);
  CHECK(*first_common({a, b}, 0, 0.4) == Approx(1.6));
  CHECK(*first_common({a, b}, 0, 0.7) == Approx(5.6));
  CHECK_FALSE(first_common({a, {{3, 4}}}, 0, 0).has_value());
}

Input two_joints() {
  Input input;
  input.joints = 2;
  input.set_limits(0, 2, 8, 60);
  input.set_limits(1, 1.5, 5, 90);
  input.velocity = {0.5, -0.2};
  input.target_position = {1, -0.3};
  input.target_velocity = {0.1, 0};
  return input;
}

TEST_CASE("the referee accepts the optimum and refuses what is a little longer or shorter") {
  const auto generator = std::make_unique<GeneratorOf<double>>(0.001);
  const Input input = two_joints();
  REQUIRE_FALSE(is_failure(generator->plan(input)));
  CHECK(judge(input, *generator) == Verdict::kOptimal);
  const double shortest_s = generator->duration_s();

  Input longer = input;
  longer.minimum_duration_s = shortest_s * (1 + 3e-6);
  generator->plan(longer);
  CHECK(judge(longer, *generator) == Verdict::kOptimal);
  CHECK(judge(input, *generator) == Verdict::kTooLong);

  Input faster = input;
  for (int i = 0; i < input.joints; ++i) {
    faster.max_velocity[i] *= 1 + 1e-4;
    faster.max_acceleration[i] *= 1 + 1e-4;
    faster.min_acceleration[i] *= 1 + 1e-4;
  }
  generator->plan(faster);
  REQUIRE(generator->duration_s() < shortest_s);
  CHECK(judge(input, *generator) == Verdict::kTooShort);
}

TEST_CASE("the referee knows every mode") {
  const auto generator = std::make_unique<GeneratorOf<double>>(0.001);
  Input input = two_joints();
  SECTION("alone") {
    input.synchronisation = firmware::trajectory::Synchronisation::kNone;
  }
  SECTION("velocity") {
    input.interface = Interface::kVelocity;
  }
  SECTION("steps") {
    input.duration_step_s = 0.01;
  }
  SECTION("no jerk limit") {
    input.max_jerk[0] = INFINITY;
  }
  SECTION("a start outside the limits") {
    input.velocity[0] = 3;
  }
  REQUIRE_FALSE(is_failure(generator->plan(input)));
  CHECK(judge(input, *generator) == Verdict::kOptimal);
  // The same plan for an axis that is allowed a little more is no longer the best.
  for (int i = 0; i < input.joints; ++i) {
    for (auto* limits : {&input.max_velocity, &input.min_velocity, &input.max_acceleration,
                         &input.min_acceleration, &input.max_jerk}) {
      (*limits)[i] *= 1.1;
    }
  }
  CHECK(judge(input, *generator) != Verdict::kOptimal);
}

}  // namespace
}  // namespace hoof::tools::trajectory
