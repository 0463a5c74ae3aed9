// Opening that follows the sand, alone and in the controller's gait on synthetic sand.
#include "firmware/control/adaptive_opening.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "tests/firmware/control/controller_bench.h"

using namespace hoof::firmware::control;
using Bench = test::ControllerBench;

namespace {

AdaptiveSettings enabled() {
  AdaptiveSettings s;
  s.enabled = 1.0f;
  return s;
}

constexpr float kLargest_rad = 0.698132f;

/// A whole step by hand: a stance of this depth, then the air.
std::optional<float> stance(AdaptiveOpening& a, float sinkage_m, float target_rad) {
  GroundEstimate ground;
  ground.contact = true;
  for (const float share : {0.3f, 1.0f, 0.6f}) {
    ground.sinkage_m = share * sinkage_m;
    REQUIRE_FALSE(a.update(ground, true, false, target_rad));
  }
  ground = {};
  REQUIRE_FALSE(a.update(ground, false, false, target_rad));  // not long enough in the air
  const std::optional<float> first = a.update(ground, false, true, target_rad);
  REQUIRE_FALSE(a.update(ground, false, true, first.value_or(target_rad)));  // once per stance
  return first;
}

}  // namespace

TEST_CASE("Deeper opens, shallower closes, by gain, step and bounds") {
  AdaptiveOpening a(enabled(), kLargest_rad);
  a.start(0.3f);
  CHECK_FALSE(a.moved());
  CHECK(*stance(a, 0.014f, 0.3f) == Approx(0.34f));  // 10 rad/m * 4 mm
  CHECK(a.moved());
  CHECK(*stance(a, 0.030f, 0.34f) == Approx(0.39f));  // wished 0.5, one step
  CHECK(*stance(a, 0.030f, 0.46f) == Approx(0.50f));  // the rest
  CHECK_FALSE(stance(a, 0.0315f, 0.50f));             // within the deadband
  CHECK_FALSE(stance(a, 0.0285f, 0.50f));
  CHECK(*stance(a, 0.100f, 0.67f) == Approx(kLargest_rad));  // never beyond the largest
  CHECK(*stance(a, 0.012f, 0.50f) == Approx(0.45f));
  CHECK(*stance(a, 0.000f, 0.33f) == 0.3f);  // never below the ordered
  CHECK_FALSE(stance(a, 0.005f, 0.3f));
  a.start(0.1f);
  CHECK_FALSE(a.moved());
  CHECK_FALSE(a.update({}, false, true, 0.1f));  // nothing learnt yet
}

TEST_CASE("Contact felt in the air is no stance, contact lost in the stance no swing") {
  AdaptiveOpening a(enabled(), kLargest_rad);
  a.start(0.3f);
  GroundEstimate felt;
  felt.contact = true;
  felt.sinkage_m = 0.05f;
  CHECK_FALSE(a.update(felt, false, true, 0.3f));
  CHECK_FALSE(a.update({}, false, true, 0.3f));
  felt.sinkage_m = 0.014f;
  CHECK_FALSE(a.update(felt, true, false, 0.3f));
  CHECK_FALSE(a.update({}, true, false, 0.3f));  // chatter
  felt.sinkage_m = 0.004f;
  CHECK_FALSE(a.update(felt, true, false, 0.3f));
  CHECK(*a.update({}, false, true, 0.3f) == Approx(0.34f));  // the deepest of both
}

TEST_CASE("Any sinkage, any target: always between ordered and largest, a step at most") {
  INFO("seed 81");
  std::mt19937 random(81);
  std::uniform_real_distribution<float> sinkage(-0.05f, 0.3f), ordered(0.0f, 0.69f);
  AdaptiveOpening a(enabled(), kLargest_rad);
  for (int n = 0; n < 300; ++n) {
    const float ordered_rad = ordered(random);
    a.start(ordered_rad);
    float target_rad = ordered_rad;
    for (int step = 0; step < 20; ++step) {
      const float depth_m = sinkage(random);
      CAPTURE(ordered_rad, depth_m, target_rad);
      const float next_rad = stance(a, depth_m, target_rad).value_or(target_rad);
      REQUIRE(next_rad >= ordered_rad);
      REQUIRE(next_rad <= kLargest_rad);
      REQUIRE(std::abs(next_rad - target_rad) <= 0.05f + 1e-6f);
      target_rad = next_rad;
    }
  }
}

namespace {

/// Sand that pushes by depth below its own level, on the controller's plain joints.
struct Walk {
  Bench bench;
  double level_m = 0.0;          // of this sand, above the level the leg is told
  double stiffness_N_m = 20000;  // 700 N at the deepest point
  struct Sample {
    bool contact, below;
    float set_point_rad, target_rad;
    Wish wish;
  };
  std::vector<Sample> samples;

  explicit Walk(const Settings& settings) : bench({}, settings) {}

  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const LegMotion& leg = bench.controller.leg();
      const LegAngles q{float(bench.plants[1].q_rad), float(bench.plants[2].q_rad)};
      const double height_m = leg.kinematics().foot_m(q).z + 0.5 - level_m;
      const float force_N = height_m < 0.0 ? float(-stiffness_N_m * height_m) : 0.0f;
      const LegAngles push = leg.kinematics().joint_torque_Nm(q, {0.0f, force_N});
      // The plain joints weigh nothing; what the drives hold for gravity is taken off here.
      const LegAngles own = leg.dynamics().torque_Nm(q, {}, {});
      bench.plants[1].load_Nm = push.hip_rad - own.hip_rad;
      bench.plants[2].load_Nm = push.knee_rad - own.knee_rad;
      bench.tick();
      const FootController& c = bench.controller;
      samples.push_back({c.ground().contact, c.leg().path().below_sand(), c.toe().set_point_rad(),
                         c.toe().target_rad(), c.wish()});
    }
  }

  void start(float toe_rad, float frequency_Hz) {
    REQUIRE(bench.controller.order_run(toe_rad, frequency_Hz) == Acceptance::kAccepted);
    REQUIRE(bench.run_until(Mode::kRunning) > 0);
    samples.clear();
  }
};

Settings adaptive(float reference_m = 0.01f) {
  Settings s;
  s.adaptive.enabled = 1.0f;
  s.adaptive.reference_sinkage_m = reference_m;
  return s;
}

bool same_bits(const Wish& a, const Wish& b) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (a.joint[i].action != b.joint[i].action) return false;
    if (std::memcmp(&a.joint[i].command, &b.joint[i].command, sizeof(JointCommand)) != 0) {
      return false;
    }
  }
  return a.mode == b.mode;
}

}  // namespace

TEST_CASE("In the gait: opens step by step in the air only, down to the sand's wish, both ways") {
  for (const float frequency_Hz : {0.45f, 1.12f}) {
    Walk walk(adaptive());
    walk.start(0.2f, frequency_Hz);
    walk.run(int(14.0f / frequency_Hz * 1000.0f));
    REQUIRE(walk.bench.controller.mode() == Mode::kRunning);
    const float open_rad = walk.bench.controller.toe().target_rad();
    CAPTURE(frequency_Hz, open_rad);
    CHECK(open_rad > 0.3f);  // 30 mm felt, 20 more than the reference: 0.2 rad more
    CHECK(open_rad < 0.5f);
    float previous_rad = 0.2f;
    for (const Walk::Sample& s : walk.samples) {
      if (s.set_point_rad != previous_rad) {
        REQUIRE_FALSE(s.contact);
        REQUIRE_FALSE(s.below);
      }
      REQUIRE(s.set_point_rad >= 0.2f - 1e-6f);
      REQUIRE(s.set_point_rad <= kLargest_rad + 1e-6f);
      previous_rad = s.set_point_rad;
    }
    walk.level_m = -0.025;  // 10 mm of sand are left
    walk.samples.clear();
    walk.run(int(14.0f / frequency_Hz * 1000.0f));
    CHECK(walk.bench.controller.toe().target_rad() < 0.2f + 0.021f);  // but the deadband
    CHECK(walk.bench.controller.faults() == 0);
  }
}

TEST_CASE("Off, the wishes are the same bits whatever its other settings are") {
  Settings odd;
  odd.adaptive.gain_rad_m = 50.0f;
  odd.adaptive.reference_sinkage_m = 0.0f;
  odd.adaptive.deadband_m = 0.0f;
  Walk plain{Settings{}}, off{odd}, on{adaptive(0.0f)};
  for (Walk* walk : {&plain, &off, &on}) {
    walk->start(0.2f, 1.12f);
    walk->run(5000);
  }
  bool on_differs = false;
  for (std::size_t i = 0; i < plain.samples.size(); ++i) {
    REQUIRE(same_bits(plain.samples[i].wish, off.samples[i].wish));
    on_differs = on_differs || !same_bits(plain.samples[i].wish, on.samples[i].wish);
  }
  CHECK(on_differs);
}

TEST_CASE("Orders begin anew at their angle; another frequency alone keeps what was learnt") {
  Walk walk(adaptive());
  walk.start(0.2f, 1.12f);
  walk.run(6000);
  FootController& c = walk.bench.controller;
  const float open_rad = c.toe().target_rad();
  REQUIRE(open_rad > 0.25f);
  REQUIRE(c.order_run(0.2f, 0.8f) == Acceptance::kAccepted);
  CHECK(c.toe().target_rad() == open_rad);
  REQUIRE(c.order_run(0.1f, 0.8f) == Acceptance::kAccepted);
  CHECK(c.toe().target_rad() == 0.1f);
  walk.run(6000);
  REQUIRE(c.toe().target_rad() > 0.15f);
  REQUIRE(c.order_ready(0.1f) == Acceptance::kAccepted);
  CHECK(c.toe().target_rad() == 0.1f);
  walk.run(3000);
  CHECK(c.mode() == Mode::kReady);
  CHECK(c.toe().target_rad() == 0.1f);
  c.order_stop();
  walk.run(3000);
  REQUIRE(c.mode() == Mode::kOff);
  REQUIRE(c.order_ready(0.1f) == Acceptance::kAccepted);
  walk.run(3000);
  CHECK(c.toe().target_rad() == 0.1f);
}

TEST_CASE("A gait too fast, or a toe too slow, for a step in the air does not adapt") {
  Settings slow = adaptive();
  slow.toe.speed_rad_s = 0.05f;  // a second for a step
  Walk walk(slow);
  walk.start(0.02f, 1.12f);
  walk.run(6000);
  REQUIRE(walk.bench.controller.mode() == Mode::kRunning);
  CHECK(walk.bench.controller.toe().target_rad() == 0.02f);
}

TEST_CASE("A step that meets sand early ends at once") {
  Settings settings = adaptive();
  settings.adaptive.largest_step_rad = 0.2f;  // a step of 0.05 is over before it can be ended
  settings.toe.speed_rad_s = 0.5f;
  Walk walk(settings);
  walk.start(0.2f, 0.45f);
  while (walk.bench.controller.toe().target_rad() == 0.2f) walk.run(1);
  walk.run(40);  // on its way
  REQUIRE(walk.bench.controller.toe().moving());
  walk.level_m = 0.08;  // sand up to above the top of the path
  int ticks = 0;
  while (!walk.bench.controller.ground().contact && ticks < 200) walk.run(1), ++ticks;
  REQUIRE(walk.bench.controller.toe().moving());
  walk.run(60);
  CHECK_FALSE(walk.bench.controller.toe().moving());
  CHECK(walk.bench.controller.toe().target_rad() < 0.3f);
  CHECK(walk.bench.controller.toe().target_rad() > 0.2f);
}
