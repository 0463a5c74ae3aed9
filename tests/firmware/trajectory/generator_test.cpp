// The generator on line: one sample per control period.
#include "firmware/trajectory/generator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace hoof::firmware::trajectory {
namespace {

constexpr int kJoints = 3;
using Generator3 = Generator<float, kJoints>;
using Input3 = Input<float, kJoints>;
using Output3 = Output<float, kJoints>;

constexpr float kPeriod_s = 0.001f;
constexpr float kVelocity = 3, kAcceleration = 20, kJerk = 400;
// Samples are float: a step of one period is exact to some 1e-6 of the values.
constexpr float kStepTolerance = 2e-5f;

Input3 move(float a, float b, float c) {
  Input3 input;
  for (int i = 0; i < kJoints; ++i) input.set_limits(i, kVelocity, kAcceleration, kJerk);
  input.target_position = {a, b, c};
  return input;
}

// Follows the outputs and fails when one leaves a limit or jumps.
class Follower {
 public:
  void check(const Output3& now) {
    for (int i = 0; i < kJoints; ++i) {
      REQUIRE(std::isfinite(now.position[i]));
      REQUIRE(std::fabs(now.acceleration[i]) <= kAcceleration * (1 + 1e-4f));
      REQUIRE(std::fabs(now.velocity[i]) <= kVelocity * (1 + 1e-4f));
      if (started_) {
        REQUIRE(std::fabs(now.acceleration[i] - last_.acceleration[i]) <=
                kJerk * kPeriod_s * (1 + 1e-3f) + kStepTolerance);
        const float step = now.position[i] - last_.position[i];
        const float mean = (now.velocity[i] + last_.velocity[i]) / 2;
        REQUIRE(std::fabs(step - mean * kPeriod_s) <= kStepTolerance);
      }
    }
    last_ = now;
    started_ = true;
  }

 private:
  Output3 last_;
  bool started_ = false;
};

TEST_CASE("a move ends once, on the target, bit by bit") {
  Generator3 generator(kPeriod_s);
  Output3 output;
  Follower follower;
  const Input3 input = move(1, -0.4f, 0.05f);
  int finished = 0;
  int samples_until_end = 0;
  for (int k = 0; k < 3000; ++k) {
    const Result result = generator.update(input, output);
    REQUIRE_FALSE(is_failure(result));
    follower.check(output);
    CHECK(output.new_plan == (k == 0));
    if (result == Result::kFinished) {
      ++finished;
      samples_until_end = k + 1;
    }
    if (finished > 0) {
      REQUIRE(output.position == input.target_position);
      REQUIRE(output.velocity == input.target_velocity);
    }
  }
  CHECK(finished == 1);
  CHECK(generator.update(input, output) == Result::kHolding);
  CHECK(samples_until_end == static_cast<int>(std::ceil(generator.duration_s() / kPeriod_s)));
}

TEST_CASE("an unchanged goal is not planned again, a changed one is, without a jump") {
  Generator3 generator(kPeriod_s);
  Output3 output;
  Follower follower;
  Input3 input = move(1, -0.4f, 0.05f);
  int plans = 0;
  for (int k = 0; k < 4000; ++k) {
    if (k == 200) input.target_position = {-1, 0.2f, 0.3f};
    if (k == 300) input.max_velocity[0] = 2;
    input.position = output.position;  // a measurement, say: must not matter
    input.position[0] += 0.01f;
    generator.update(input, output);
    follower.check(output);
    plans += output.new_plan;
  }
  CHECK(plans == 3);
  CHECK(output.position == input.target_position);
}

TEST_CASE("a refused goal stops the axes, says why, and a good one goes on") {
  Generator3 generator(kPeriod_s);
  Output3 output;
  Follower follower;
  Input3 input = move(2, -0.4f, 0.05f);
  for (int k = 0; k < 200; ++k) {
    generator.update(input, output);
    follower.check(output);
  }
  Input3 bad = input;
  bad.target_position[1] = std::numeric_limits<float>::quiet_NaN();
  int plans = 0;
  for (int k = 0; k < 600; ++k) {
    CHECK(generator.update(bad, output) == Result::kInvalidInput);
    CHECK(output.stopping);
    follower.check(output);
    plans += output.new_plan;
  }
  CHECK(plans == 1);
  CHECK(generator.validation_error().quantity == Quantity::kTargetPosition);
  CHECK(generator.validation_error().joint == 1);
  for (int i = 0; i < kJoints; ++i) CHECK(output.velocity[i] == 0);
  for (int k = 0; k < 3000; ++k) {
    generator.update(input, output);
    follower.check(output);
  }
  CHECK(output.position == input.target_position);
}

TEST_CASE("a goal refused from the start moves nothing") {
  Generator3 generator(kPeriod_s);
  Output3 output;
  Input3 bad = move(1, 1, 1);
  bad.max_jerk[2] = -1;
  bad.position = {0.5f, 0.25f, 0.125f};
  for (int k = 0; k < 10; ++k) {
    CHECK(generator.update(bad, output) == Result::kInvalidInput);
    CHECK(output.position == bad.position);
  }
}

TEST_CASE("work spread over updates gives the same motion later") {
  Output3 output;
  Input3 input = move(1, -0.4f, 0.05f);
  Generator3 at_once(kPeriod_s);
  at_once.plan(input);
  for (const int units : {1, 2, 5}) {
    CAPTURE(units);
    Generator3 generator(kPeriod_s);
    generator.set_work_per_update(units);
    Follower follower;
    int finished_at = -1;
    int first_plan_at = -1;
    for (int k = 0; k < 4000; ++k) {
      if (k == 2000) input.target_position = {-1, 0.2f, 0.3f};
      const Result result = generator.update(input, output);
      REQUIRE_FALSE(is_failure(result));
      follower.check(output);
      if (result == Result::kFinished && finished_at < 0) finished_at = k;
      if (output.new_plan && !output.stopping && first_plan_at < 0) first_plan_at = k;
    }
    const int latency = (6 * kJoints + units - 1) / units + 1;
    CHECK(first_plan_at == latency);
    CHECK(finished_at - first_plan_at + 1 ==
          static_cast<int>(std::ceil(at_once.duration_s() / kPeriod_s)));
    CHECK(output.position == input.target_position);
    input = move(1, -0.4f, 0.05f);
  }
}

TEST_CASE("a goal changed under way is taken over without a jump when the work is spread") {
  Generator3 generator(kPeriod_s);
  generator.set_work_per_update(1);
  Output3 output;
  Follower follower;
  Input3 input = move(1, -0.4f, 0.05f);
  for (int k = 0; k < 6000; ++k) {
    // Sooner than a plan is ready: the plan under way is finished, then the newest goal planned.
    if (k < 3000 && k % 7 == 0) input.target_position[0] = 0.5f + 0.0001f * static_cast<float>(k);
    const Result result = generator.update(input, output);
    REQUIRE_FALSE(is_failure(result));
    follower.check(output);
  }
  CHECK(output.position == input.target_position);
}

TEST_CASE("a jog goes on at its velocity") {
  Generator3 generator(kPeriod_s);
  Output3 output;
  Follower follower;
  Input3 input = move(0, 0, 0);
  input.interface = Interface::kVelocity;
  input.target_velocity = {1, -2, 0};
  for (int k = 0; k < 1000; ++k) {
    generator.update(input, output);
    follower.check(output);
  }
  CHECK(output.velocity == input.target_velocity);
  const float before = output.position[0];
  generator.update(input, output);
  CHECK(output.position[0] - before == Approx(kPeriod_s).epsilon(0.01));  // float position steps
}

}  // namespace
}  // namespace hoof::firmware::trajectory
