// Each rule of validate(), by the value it names.
#include "firmware/trajectory/validate.h"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

namespace hoof::firmware::trajectory {
namespace {

using Input2 = Input<double, 2>;

Input2 good() {
  Input2 input;
  input.set_limits(0, 2, 4, 20);
  input.set_limits(1, 2, 4, 20);
  return input;
}

void expect(const std::function<void(Input2&)>& spoil, Quantity quantity, Rule rule, int joint) {
  Input2 input = good();
  spoil(input);
  const ValidationError<double> error = validate(input);
  CAPTURE(name(quantity), name(error.quantity), name(error.rule));
  CHECK(error);
  CHECK(error.quantity == quantity);
  CHECK(error.rule == rule);
  CHECK(error.joint == joint);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST_CASE("a good input is valid, with or without a jerk limit") {
  CHECK_FALSE(validate(good()));
  Input2 input = good();
  input.max_jerk[1] = kInf;
  CHECK_FALSE(validate(input));
}

TEST_CASE("NaN and infinity are refused by field and joint") {
  for (const double bad : {kNan, kInf, -kInf}) {
    expect([=](Input2& in) { in.position[1] = bad; }, Quantity::kPosition, Rule::kFinite, 1);
    expect([=](Input2& in) { in.velocity[1] = bad; }, Quantity::kVelocity, Rule::kFinite, 1);
    expect([=](Input2& in) { in.acceleration[0] = bad; }, Quantity::kAcceleration, Rule::kFinite,
           0);
    expect([=](Input2& in) { in.target_position[0] = bad; }, Quantity::kTargetPosition,
           Rule::kFinite, 0);
    expect([=](Input2& in) { in.target_velocity[1] = bad; }, Quantity::kTargetVelocity,
           Rule::kFinite, 1);
    expect([=](Input2& in) { in.target_acceleration[1] = bad; }, Quantity::kTargetAcceleration,
           Rule::kFinite, 1);
    expect([=](Input2& in) { in.max_velocity[1] = bad; }, Quantity::kMaxVelocity, Rule::kFinite, 1);
    expect([=](Input2& in) { in.min_velocity[1] = bad; }, Quantity::kMinVelocity, Rule::kFinite, 1);
    expect([=](Input2& in) { in.max_acceleration[1] = bad; }, Quantity::kMaxAcceleration,
           Rule::kFinite, 1);
    expect([=](Input2& in) { in.min_acceleration[1] = bad; }, Quantity::kMinAcceleration,
           Rule::kFinite, 1);
    expect([=](Input2& in) { in.minimum_duration_s = bad; }, Quantity::kMinimumDuration,
           Rule::kFinite, -1);
    expect([=](Input2& in) { in.duration_step_s = bad; }, Quantity::kDurationStep, Rule::kFinite,
           -1);
  }
  expect([](Input2& in) { in.max_jerk[0] = kNan; }, Quantity::kMaxJerk, Rule::kAtLeast, 0);
}

TEST_CASE("limits have the right sign") {
  expect([](Input2& in) { in.max_velocity[1] = -1; }, Quantity::kMaxVelocity, Rule::kAtLeast, 1);
  expect([](Input2& in) { in.min_velocity[1] = 1; }, Quantity::kMinVelocity, Rule::kAtMost, 1);
  expect([](Input2& in) { in.max_acceleration[0] = -1; }, Quantity::kMaxAcceleration,
         Rule::kAtLeast, 0);
  expect([](Input2& in) { in.min_acceleration[0] = 1; }, Quantity::kMinAcceleration, Rule::kAtMost,
         0);
  expect([](Input2& in) { in.max_jerk[0] = -1; }, Quantity::kMaxJerk, Rule::kAtLeast, 0);
  expect([](Input2& in) { in.minimum_duration_s = -1; }, Quantity::kMinimumDuration, Rule::kAtLeast,
         -1);
  expect([](Input2& in) { in.joints = 3; }, Quantity::kJoints, Rule::kAtMost, -1);
  expect([](Input2& in) { in.joints = 0; }, Quantity::kJoints, Rule::kAtLeast, -1);
}

TEST_CASE("the target must be reachable within the limits") {
  expect([](Input2& in) { in.target_velocity[1] = 2.1; }, Quantity::kTargetVelocity, Rule::kAtMost,
         1);
  expect([](Input2& in) { in.target_velocity[1] = -2.1; }, Quantity::kTargetVelocity,
         Rule::kAtLeast, 1);
  expect([](Input2& in) { in.target_acceleration[1] = 4.1; }, Quantity::kTargetAcceleration,
         Rule::kAtMost, 1);
  // Ending at full speed while slowing down: the way in was faster.
  expect(
      [](Input2& in) {
        in.target_velocity[0] = 2;
        in.target_acceleration[0] = -1;
      },
      Quantity::kTargetVelocity, Rule::kEntryAtMost, 0);
  expect(
      [](Input2& in) {
        in.target_velocity[0] = -2;
        in.target_acceleration[0] = 1;
      },
      Quantity::kTargetVelocity, Rule::kEntryAtLeast, 0);
  Input2 leaving = good();  // the other way round it is fine
  leaving.target_velocity[0] = 1.9;
  leaving.target_acceleration[0] = 4;
  CHECK_FALSE(validate(leaving));
  leaving.interface = Interface::kVelocity;
  leaving.target_velocity[0] = 50;
  leaving.target_position[0] = kNan;
  CHECK_FALSE(validate(leaving));
}

}  // namespace
}  // namespace hoof::firmware::trajectory
