#include "firmware/safety/command_limits.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
using control::JointCommand;
using control::JointState;

namespace {

constexpr const JointLimits& kHip = kLimits[1];

JointState measured(float position_rad, float velocity_rad_s, bool referenced = true) {
  JointState state;
  state.position_rad = position_rad;
  state.velocity_rad_s = velocity_rad_s;
  state.received = true;
  state.referenced = referenced;
  return state;
}

}  // namespace

TEST_CASE("A harmless command passes every limit untouched") {
  JointCommand c{0.02f, 0.5f, 1000.0f, 100.0f, 30.0f};
  const JointCommand before = c;
  CHECK(limit_targets(kHip, measured(0.0f, 0.4f), c) == 0);
  CHECK(limit_torque(kHip, kHip.torque_Nm, measured(0.0f, 0.4f), 20.0f, c) == 0);
  CHECK(c.position_rad == before.position_rad);
  CHECK(c.torque_Nm == before.torque_Nm);
}

TEST_CASE("Each limit of the targets cuts on both sides and names itself") {
  struct Case {
    JointCommand command;
    JointState state;
    LimitBits bits;
    JointCommand expected;
  };
  const Case cases[] = {
      {{0, 0, 30000, 0, 0}, measured(0, 0), limit::kGain, {0, 0, 20000, 0, 0}},
      {{0, 0, -1, 0, 0}, measured(0, 0), limit::kGain, {0, 0, 0, 0, 0}},
      {{0, 0, 0, 600, 0}, measured(0, 0), limit::kGain, {0, 0, 0, 500, 0}},
      {{0, 0, 0, -2, 0}, measured(0, 0), limit::kGain, {0, 0, 0, 0, 0}},
      {{0, 7, 0, 1, 0}, measured(0, 0), limit::kVelocity, {0, 5, 0, 1, 0}},
      {{0, -7, 0, 1, 0}, measured(0, 0), limit::kVelocity, {0, -5, 0, 1, 0}},
      {{0.5f, 0, 10, 0, 0}, measured(0, 0), limit::kDistance, {0.1f, 0, 10, 0, 0}},
      {{-0.5f, 0, 10, 0, 0}, measured(0, 0), limit::kDistance, {-0.1f, 0, 10, 0, 0}},
      {{1.7f, 0, 10, 0, 0}, measured(1.58f, 0), limit::kTravel, {1.6f, 0, 10, 0, 0}},
      {{-1.3f, 0, 10, 0, 0}, measured(-1.15f, 0), limit::kTravel, {-1.2f, 0, 10, 0, 0}},
      // Without a known zero there is no travel; without stiffness no position.
      {{1.7f, 0, 10, 0, 0}, measured(1.65f, 0, false), 0, {1.7f, 0, 10, 0, 0}},
      {{9.0f, 0, 0, 1, 0}, measured(0, 0), 0, {9.0f, 0, 0, 1, 0}},
  };
  for (const Case& test : cases) {
    JointCommand c = test.command;
    CHECK(limit_targets(kHip, test.state, c) == test.bits);
    CHECK(c.position_rad == Approx(test.expected.position_rad));
    CHECK(c.velocity_rad_s == test.expected.velocity_rad_s);
    CHECK(c.kp_Nm_rad == test.expected.kp_Nm_rad);
    CHECK(c.kd_Nm_s_rad == test.expected.kd_Nm_s_rad);
  }
}

TEST_CASE("Limits that cut together are all named") {
  for (const float sign : {1.0f, -1.0f}) {
    JointCommand c{sign * 3.0f, sign * 9.0f, 30e3f, 900.0f, 0.0f};
    const JointState state = measured(sign > 0 ? 1.45f : -1.05f, 0.0f);
    CHECK(limit_targets(kHip, state, c) ==
          (limit::kGain | limit::kVelocity | limit::kTravel | limit::kDistance));
    JointCommand hot{.torque_Nm = sign * 350.0f};
    CHECK(limit_torque(kHip, 300.0f, measured(0.0f, 0.0f), 0.0f, hot) ==
          (limit::kTorque | limit::kOverload | limit::kTorqueRate));
    CHECK(hot.torque_Nm == Approx(sign * 100.0f));
    hot = {.torque_Nm = sign * 310.0f};
    CHECK(limit_torque(kHip, 300.0f, measured(0.0f, 0.0f), sign * 290.0f, hot) == limit::kOverload);
    CHECK(hot.torque_Nm == Approx(sign * 300.0f));
    // Beyond the wire, but not beyond the ceiling when stiffness pulls the other way.
    hot = {-sign * 0.02f, 0.0f, 10e3f, 0.0f, sign * 450.0f};
    CHECK(limit_torque(kHip, 300.0f, measured(0.0f, 0.0f), sign * 190.0f, hot) == limit::kTorque);
    CHECK(hot.torque_Nm == sign * 400.0f);
  }
}

TEST_CASE("Where the wire's range ends, targets give way: position first, speed for what is left") {
  for (const float sign : {1.0f, -1.0f}) {
    // The feed-forward stands at its end already; 150 Nm of stiffness, 60 of damping.
    const JointState state = measured(0.01f, 0.1f);
    const auto wish = [&] {
      return JointCommand{0.01f + sign * 0.03f, 0.1f + sign * 0.6f, 5000.0f, 100.0f, 0.0f};
    };
    // Less feed-forward as far as it goes: nothing else moves.
    JointCommand c = wish();
    shift_torque(kHip, state, -sign * 400.0f, c);
    CHECK(c.torque_Nm == -sign * 400.0f);
    CHECK(c.position_rad == wish().position_rad);
    // 100 more than the feed-forward takes: from stiffness, of which 50 stay.
    c = wish();
    shift_torque(kHip, state, -sign * 500.0f, c);
    CHECK(c.torque_Nm == -sign * 400.0f);
    CHECK(c.position_rad == Approx(0.01f + sign * 0.01f));
    CHECK(c.velocity_rad_s == wish().velocity_rad_s);
    // 150 more: all of the stiffness, none of the damping.
    c = wish();
    shift_torque(kHip, state, -sign * 550.0f, c);
    CHECK(c.position_rad == Approx(0.01f));
    CHECK(c.velocity_rad_s == Approx(0.1f + sign * 0.6f).margin(1e-5));
    // 190 more: 20 of damping stay.
    c = wish();
    shift_torque(kHip, state, -sign * 590.0f, c);
    CHECK(c.position_rad == Approx(0.01f));
    CHECK(c.velocity_rad_s == Approx(0.1f + sign * 0.2f));
    // More than all of it: what is there goes, no target passes what is measured.
    c = wish();
    shift_torque(kHip, state, -sign * 900.0f, c);
    CHECK(c.position_rad == Approx(0.01f));
    CHECK(c.velocity_rad_s == Approx(0.1f));
    // The other way the terms help already, and stay as they are.
    c = wish();
    shift_torque(kHip, state, sign * 500.0f, c);
    CHECK(c.torque_Nm == sign * 400.0f);
    CHECK(c.position_rad == wish().position_rad);
    CHECK(c.velocity_rad_s == wish().velocity_rad_s);
    // Without gains there is nothing that could give way; with a gain of 1 there is.
    c = {0.5f, 0.5f, 0.0f, 0.0f, 0.0f};
    shift_torque(kHip, state, -sign * 500.0f, c);
    CHECK(c.position_rad == 0.5f);
    CHECK(c.velocity_rad_s == 0.5f);
    c = {0.01f, 0.1f + sign * 3.0f, 0.0f, 1.0f, 0.0f};
    shift_torque(kHip, state, -sign * 402.0f, c);
    CHECK(c.velocity_rad_s == Approx(0.1f + sign * 1.0f));
  }
}

TEST_CASE("The limit is on the whole torque, not on its parts") {
  // 400 from stiffness and -300 feed-forward make 100: nothing to cut but the wire's range.
  JointCommand c{0.1f, 0.0f, 4000.0f, 0.0f, -300.0f};
  CHECK(limit_torque(kHip, kHip.torque_Nm, measured(0.0f, 0.0f), 100.0f, c) == 0);
  // 400 - 0 = 400 > 317: cut by feed-forward, stiffness kept.
  c = {0.1f, 0.0f, 4000.0f, 0.0f, 0.0f};
  CHECK(limit_torque(kHip, kHip.torque_Nm, measured(0.0f, 0.0f), 317.0f, c) == limit::kTorque);
  CHECK(c.kp_Nm_rad == 4000.0f);
  CHECK(c.position_rad == 0.1f);
  CHECK(c.torque_Nm == Approx(-83.0f));
}

TEST_CASE("Pure damping may set in at once, but is bound by the ceiling") {
  JointCommand c{.kd_Nm_s_rad = 200.0f};
  CHECK(limit_torque(kHip, kHip.torque_Nm, measured(0.0f, 1.0f), 200.0f, c) == 0);
  CHECK(c.torque_Nm == 0.0f);
  CHECK(limit_torque(kHip, kHip.torque_Nm, measured(0.0f, 4.0f), 0.0f, c) == limit::kTorque);
  CHECK(predicted_torque_Nm(c, measured(0.0f, 4.0f)) == Approx(-317.0f));
}

TEST_CASE("Whatever finite command comes, the torque made of it keeps ceiling and rate", "[slow]") {
  const unsigned seed = 11;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  const auto in = [&](float a, float b) {
    return std::uniform_real_distribution<float>(a, b)(random);
  };
  for (int n = 0; n < 200000; ++n) {
    const std::size_t joint = random() % 3;
    const JointLimits& limits = kLimits[joint];
    const JointState state = measured(in(-1, 1), in(-15, 15), random() % 2 == 0);
    const JointCommand wish{in(-3, 3), in(-50, 50), in(-100, 30000), in(-10, 800), in(-900, 900)};
    JointCommand c = wish;
    const float ceiling_Nm = in(kDrives[joint].continuous_torque_Nm, limits.torque_Nm);
    const float previous_Nm = in(-ceiling_Nm, ceiling_Nm);
    limit_targets(limits, state, c);
    const float distance_rad = std::abs(c.position_rad - state.position_rad);
    const float speed_off_rad_s = std::abs(c.velocity_rad_s - state.velocity_rad_s);
    limit_torque(limits, ceiling_Nm, state, previous_Nm, c);
    const float torque_Nm = predicted_torque_Nm(c, state);
    // Terms of up to 1e4 Nm that cancel: float carries 1e-3 Nm of them.
    const float rounding_Nm = 4e-3f;
    const float change_Nm = limits.torque_rate_Nm_s * control::kTick_s;
    const std::pair<const char*, bool> promises[] = {
        // Within rounding.
        {"the position target only comes nearer to what is measured",
         std::abs(c.position_rad - state.position_rad) <= distance_rad + 1e-6f},
        {"the speed target only comes nearer to what is measured",
         std::abs(c.velocity_rad_s - state.velocity_rad_s) <= speed_off_rad_s + 1e-5f},
        {"ceiling", std::abs(torque_Nm) <= ceiling_Nm + rounding_Nm},
        {"rate", std::abs(torque_Nm - previous_Nm) <= change_Nm + rounding_Nm},
        {"feed-forward", std::abs(c.torque_Nm) <= limits.feed_forward_Nm},
        {"stiffness", c.kp_Nm_rad >= 0.0f && c.kp_Nm_rad <= limits.kp_Nm_rad},
        {"damping", c.kd_Nm_s_rad >= 0.0f && c.kd_Nm_s_rad <= limits.kd_Nm_s_rad},
    };
    for (const auto& [promise, kept] : promises) {
      if (kept) continue;
      CAPTURE(joint, state.position_rad, state.velocity_rad_s, state.referenced, ceiling_Nm);
      CAPTURE(wish.position_rad, wish.velocity_rad_s, wish.kp_Nm_rad, wish.kd_Nm_s_rad);
      CAPTURE(wish.torque_Nm, previous_Nm);
      FAIL("broken: " << promise);
    }
  }
}

TEST_CASE("Numbers that are none are told from numbers, in every field") {
  const float bad[] = {std::nanf(""), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity()};
  CHECK(is_finite(JointCommand{}));
  for (const float value : bad) {
    CHECK_FALSE(is_finite(JointCommand{value, 0, 0, 0, 0}));
    CHECK_FALSE(is_finite(JointCommand{0, value, 0, 0, 0}));
    CHECK_FALSE(is_finite(JointCommand{0, 0, value, 0, 0}));
    CHECK_FALSE(is_finite(JointCommand{0, 0, 0, value, 0}));
    CHECK_FALSE(is_finite(JointCommand{0, 0, 0, 0, value}));
  }
}
