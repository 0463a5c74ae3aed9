#include "firmware/safety/reply_watch.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "tests/firmware/safety/replies.h"

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
using control::DriveAction;
using control::FaultBits;
using control::JointState;
using control::JointWish;
namespace fault = control::fault;

TEST_CASE("Just inside its bounds a reply passes, just beyond it does not") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    Replies r(joint);
    r.state.temperature_C = 100.0f;
    CHECK(r.next() == 0);
    r.state.temperature_C = 100.1f;
    CHECK(r.next() == fault::kOverTemperature);
    const JointLimits& limits = kLimits[joint];
    for (const float sign : {1.0f, -1.0f}) {
      Replies at_end(joint);
      at_end.watch.start(at_end.now_ns);  // the first reply is no jump
      at_end.state.reading_rad = sign * std::nextafter(limits.end_of_range_rad, 0.0f);
      CHECK(at_end.next() == 0);
      at_end.state.reading_rad = sign * limits.end_of_range_rad;
      CHECK(at_end.next() == fault::kImplausibleReply);
      CHECK(at_end.look() == fault::kImplausibleReply);  // still there, though no new reply
    }
  }
}

TEST_CASE("A saturated code is seen where it is, however homing has shifted the zero") {
  Replies r(0);
  r.watch.start(r.now_ns);
  r.state.position_rad = 0.3f;  // a plausible angle: the zero lies at 12.2
  r.state.reading_rad = 12.5f;
  CHECK(r.next() == fault::kImplausibleReply);
  // And an angle beyond the drive's codes is none of the reading's business.
  r.watch.start(r.now_ns);
  r.state.referenced = false;
  r.state.position_rad = 13.0f;
  r.state.reading_rad = 0.8f;
  CHECK(r.next() == 0);
}

TEST_CASE("Beyond its travel by more than the margin a joint is a fault, where its zero is known") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const float ends[] = {kLimits[joint].lower_rad - kTravelMargin_rad,
                          kLimits[joint].upper_rad + kTravelMargin_rad};
    for (int end = 0; end < 2; ++end) {
      Replies r(joint);
      r.state.position_rad = ends[end];
      CHECK(r.next() == 0);
      r.state.position_rad = std::nextafter(ends[end], end == 0 ? -9.0f : 9.0f);
      CHECK(r.next() == fault::kOutsideTravel);
      r.state.referenced = false;
      CHECK(r.next() == 0);
    }
  }
}

TEST_CASE("Silence: 20 ms pass, a nanosecond more does not; a reply from before does not count") {
  Replies r(1);
  r.now_ns += kFreshness_ns;
  CHECK(r.look() == 0);
  r.now_ns += 1;
  CHECK(r.look() == fault::kDriveLost);

  r.watch.start(r.now_ns);
  r.state.received_ns = r.now_ns;  // of the very moment watching began: not an answer to it
  r.state.error = 1;
  r.now_ns += kFreshness_ns;
  CHECK(r.look() == 0);
  r.now_ns += 1;
  CHECK(r.look() == fault::kDriveLost);
  r.state.received_ns = r.now_ns;
  CHECK(r.look() == fault::kDriveError);
  r.state.error = 0;
  r.state.received = false;  // a time without a reply is none
  CHECK(r.look() == fault::kDriveLost);
}

TEST_CASE("A jump is what the drive could not turn in the time since the reply before") {
  // Consistent speeds, so that only the speed bound judges; toe 45, leg 20 rad/s, 1.5 ms for one.
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const float sign : {1.0f, -1.0f}) {
      for (const int late_ms : {0, 4}) {
        const float bound_rad = kLimits[joint].plausible_rad_s * (1.5e-3f + 1e-3f * late_ms);
        for (const float share : {0.999f, 1.001f}) {
          INFO("joint " << joint << " share " << share << " late " << late_ms);
          Replies r(joint);
          r.now_ns += late_ms * kMillisecond_ns;
          const float step_rad = sign * share * bound_rad;
          r.state.reading_rad += step_rad;
          // Mean speed over all ticks since the last reply makes just this way.
          r.state.velocity_rad_s = 2.0f * step_rad / (1e-3f * (1 + late_ms));
          const FaultBits found = r.next(static_cast<std::uint32_t>(1 + late_ms));
          CHECK(found == (share < 1.0f ? 0 : fault::kImplausibleReply));
        }
      }
    }
  }
}

TEST_CASE("A jump smaller than the speed bound, which the speeds do not know of, is a fault") {
  // A step d leaves d / (1 + 1 ms / 100 ms) in the integral.
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const float least_rad = kLimits[joint].drift_rad * 1.01f;
    CHECK(least_rad < kLimits[joint].plausible_rad_s * 1e-3f * 1.5f);
    for (const float sign : {1.0f, -1.0f}) {
      Replies r(joint);
      const float from_rad = r.state.reading_rad;
      CHECK(r.next_at(from_rad + sign * 0.999f * least_rad, 0.0f) == 0);
      Replies s(joint);
      CHECK(s.next_at(from_rad + sign * 1.001f * least_rad, 0.0f) == fault::kImplausibleReply);
    }
  }
}

TEST_CASE("At its very bound a jump passes") {
  for (const std::size_t joint : {0, 1}) {
    const JointLimits& limits = kLimits[joint];
    // From a reading of 0, so that the difference is exact.
    const float elapsed_s = 1e6f * 1e-9f;
    const float reach_rad = limits.plausible_rad_s * (elapsed_s + 0.5f * control::kTick_s);
    Replies r(joint);
    CHECK(r.next_at(reach_rad, 2.0f * reach_rad / control::kTick_s) == 0);
    Replies s(joint);
    CHECK(s.next_at(std::nextafter(reach_rad, 1.0f), 2.0f * reach_rad / control::kTick_s) ==
          fault::kImplausibleReply);
    // The step whose remainder in the integral is the bound itself.
    const float leak = 1.0f + control::kTick_s / kDriftMemory_s;
    float step_rad = limits.drift_rad * leak;
    while (step_rad / leak > limits.drift_rad) step_rad = std::nextafter(step_rad, 0.0f);
    REQUIRE(step_rad / leak == limits.drift_rad);
    Replies t(joint);
    CHECK(t.next_at(step_rad, 0.0f) == 0);
  }
}

TEST_CASE("All that is wrong with a reply is named at once") {
  Replies r(1);
  r.passed = {DriveAction::kCommand, {.torque_Nm = 200.0f}};
  for (int i = 1; i < kNotFollowingTicks; ++i) REQUIRE(r.next() == 0);
  r.state.error = 1;
  r.state.temperature_C = 120.0f;
  r.place(9.0f);
  const FaultBits lasting = fault::kDriveError | fault::kOverTemperature |
                            fault::kImplausibleReply | fault::kOutsideTravel;
  CHECK(r.next() == (lasting | fault::kNotFollowing));
  CHECK(r.look() == lasting);
}

TEST_CASE("A reading that stands still while its speed does not is found, and how soon") {
  // Backward Euler of dx/dt = -v - x/tau: x_n = -v tau (1 - q^n), q = 1 / (1 + 1 ms / tau).
  const double q = 1.0 / (1.0 + 1e-3 / kDriftMemory_s);
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const double speed_rad_s : {-2.0, -0.5, 0.5, 1.8}) {
      const double share = kLimits[joint].drift_rad / (std::abs(speed_rad_s) * kDriftMemory_s);
      const int due = static_cast<int>(std::ceil(std::log(1.0 - share) / std::log(q)));
      Replies r(joint);
      // Turning well first: consistent, so nothing is in the integral.
      r.state.velocity_rad_s = static_cast<float>(speed_rad_s);
      r.state.reading_rad += 0.5e-3f * static_cast<float>(speed_rad_s);
      REQUIRE(r.next() == 0);
      int ticks = 0;
      while (r.next() == 0 && ticks < 1000) ++ticks;
      INFO("joint " << joint << " speed " << speed_rad_s << " ticks " << ticks);
      CHECK(std::abs(ticks + 1 - due) <= 1);  // rounding of readings near the bound
    }
  }
}

TEST_CASE("A slow drift, and rounding as the wire has it, are none") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const float bound_rad_s = kLimits[joint].drift_rad / kDriftMemory_s;
    for (const float share : {0.98f, 1.02f}) {
      Replies r(joint);
      FaultBits found = 0;
      for (int i = 0; i < 900 && found == 0; ++i) {
        found = r.next_at(r.state.reading_rad + share * bound_rad_s * 1e-3f, 0.0f);
      }
      CHECK(found == (share < 1.0f ? 0 : fault::kImplausibleReply));
    }
  }
}

TEST_CASE("Any honest motion passes: random speeds, codes of the wire, a lagging speed filter") {
  const unsigned seed = 5;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  // Codes: position 25 / 65535 and 6.4 / 65535 rad, speed 90 / 4095 and 40 / 4095 rad/s.
  const double position_code[] = {25.0 / 65535, 6.4 / 65535, 6.4 / 65535};
  const double speed_code[] = {90.0 / 4095, 40.0 / 4095, 40.0 / 4095};
  const double fastest_rad_s[] = {10.0, 5.0, 5.0};
  const double slip_rad_s2 = 1000.0;  // 5 rad/s within 5 ms
  for (std::size_t joint = 0; joint < 3; ++joint) {
    Replies r(joint);
    double speed = 0.0, told = 0.0, at = r.state.reading_rad, aim = 0.0;
    for (int tick = 0; tick < 20000; ++tick) {
      if (tick % 50 == 0) {
        std::uniform_real_distribution<double> any(-fastest_rad_s[joint], fastest_rad_s[joint]);
        aim = std::abs(at) > 1.0 ? -std::copysign(1.0, at) : any(random);
      }
      for (int i = 0; i < 20; ++i) {  // the drive's own 20 kHz
        const double change = aim - speed;
        speed += std::copysign(std::min(std::abs(change), slip_rad_s2 * 5e-5), change);
        at += speed * 5e-5;
        told += (1.0 - std::exp(-2.0 * M_PI * 200.0 * 5e-5)) * (speed - told);
      }
      r.state.position_rad = 0.0f;
      // Speeds cut towards zero, as a drive that only shifts bits does.
      const auto reading = static_cast<float>(std::round(at / position_code[joint]));
      const auto velocity = static_cast<float>(std::trunc(told / speed_code[joint]));
      REQUIRE(r.next_at(reading * static_cast<float>(position_code[joint]),
                        velocity * static_cast<float>(speed_code[joint])) == 0);
    }
  }
}

TEST_CASE("Lost replies are gaps that the speeds bridge") {
  for (const float way_rad : {0.040f, 0.040f - 0.021f, 0.040f + 0.023f}) {
    Replies r(1);
    r.state.velocity_rad_s = 4.0f;
    r.state.reading_rad += 0.5e-3f * 4.0f;
    REQUIRE(r.next() == 0);
    // Nine ticks without a reply, then one: 10 ms of way. A step leaves 1 / 1.1 of it.
    for (int i = 0; i < 9; ++i) {
      r.now_ns += kMillisecond_ns;
      REQUIRE(r.look() == 0);
    }
    r.state.reading_rad += way_rad;
    CHECK(r.next() == (way_rad > 0.06f ? fault::kImplausibleReply : 0));
  }
}

TEST_CASE(
    "Between two replies, time by SYNC and by the local clock may differ: either is believed") {
  // 10 ms by the clock, one tick; 4 rad/s: 4 to 40 mrad are honest. 20 * 1.01 = 20.2 more is not.
  struct Case {
    float way_rad;
    bool passes;
  };
  for (const float sign : {1.0f, -1.0f}) {
    for (const Case& c :
         {Case{0.004f, true}, Case{0.020f, true}, Case{0.040f, true}, Case{0.0600f, true},
          Case{0.0604f, false}, Case{-0.0160f, true}, Case{-0.0164f, false}}) {
      INFO("way " << sign * c.way_rad);
      Replies r(1);
      r.state.velocity_rad_s = sign * 4.0f;
      r.state.reading_rad += sign * 0.5e-3f * 4.0f;
      REQUIRE(r.next() == 0);
      r.state.reading_rad += sign * c.way_rad;
      CHECK(r.next(1, 10 * kMillisecond_ns) == (c.passes ? 0 : fault::kImplausibleReply));
      // Nothing of an honest way stays behind, all of what is beyond does.
      Replies s = r;
      const float left_rad = c.way_rad > 0.040f   ? (c.way_rad - 0.040f) / 1.01f
                             : c.way_rad < 0.004f ? (c.way_rad - 0.004f) / 1.01f
                                                  : 0.0f;
      const float side = left_rad < 0.0f ? -1.0f : 1.0f;
      const float more_rad = 0.0202f - std::abs(left_rad);
      r.state.reading_rad += sign * (0.004f + side * (more_rad - 1e-5f));
      s.state.reading_rad += sign * (0.004f + side * (more_rad + 1e-5f));
      CHECK(r.next() == 0);
      CHECK(s.next() == fault::kImplausibleReply);
    }
  }
}

TEST_CASE("A plant slower or faster than the local clock, and SYNC that pauses, are no fault") {
  for (const std::int64_t clock_ns : {std::int64_t{300'000}, 3 * kMillisecond_ns}) {
    Replies r(1);
    r.state.velocity_rad_s = 1.8f;
    r.state.reading_rad += 0.5e-3f * 1.8f;
    REQUIRE(r.next() == 0);
    for (int i = 0; i < 500; ++i) {
      r.state.reading_rad += 1.8e-3f;
      REQUIRE(r.next(1, clock_ns) == 0);
    }
    for (int i = 0; i < 50; ++i) {
      r.state.reading_rad += 1.8e-3f * 15.0f;
      REQUIRE(r.next(1, 15 * kMillisecond_ns) == 0);
    }
  }
}

TEST_CASE("Lost replies and missed SYNC are gaps that the speeds bridge; longer ones are let be") {
  Replies r(1);
  r.state.velocity_rad_s = 4.0f;
  r.state.reading_rad += 0.5e-3f * 4.0f;
  REQUIRE(r.next() == 0);
  // Nine ticks without a reply, then one: 10 ms of way.
  for (int i = 0; i < 9; ++i) {
    r.now_ns += kMillisecond_ns;
    REQUIRE(r.look() == 0);
  }
  r.state.reading_rad += 0.040f;
  REQUIRE(r.next() == 0);
  // Twenty missed in one go count, one more does not: 19.9 of 20 ms stood still is a fault.
  for (const std::uint32_t ticks : {kLongestGap_ticks, kLongestGap_ticks + 1}) {
    Replies s(1);
    s.state.velocity_rad_s = 4.0f;
    s.state.reading_rad += 0.5e-3f * 4.0f;
    REQUIRE(s.next() == 0);
    s.now_ns += (ticks - 1) * kMillisecond_ns;
    CHECK(s.next(ticks) == (ticks == kLongestGap_ticks ? fault::kImplausibleReply : 0));
    // What follows is judged as ever.
    s.watch.start(s.now_ns);
    REQUIRE(s.next() == 0);
    s.state.reading_rad += 0.029f;
    CHECK(s.next() == fault::kImplausibleReply);
  }
}

TEST_CASE("The integral forgets in proportion to the time of a gap") {
  // 18 mrad, then a gap of 20 ticks at rest: 18 / 1.01 / 1.2 = 14.85 are left of it.
  Replies r(1);
  const float from_rad = r.state.reading_rad;
  REQUIRE(r.next_at(from_rad + 0.018f, 0.0f) == 0);
  REQUIRE(r.next(20) == 0);
  // (14.85 + d) / 1.01 = 20 for d = 5.35.
  Replies s = r;
  CHECK(r.next_at(from_rad + 0.018f + 0.0053f, 0.0f) == 0);
  CHECK(s.next_at(from_rad + 0.018f + 0.0054f, 0.0f) == fault::kImplausibleReply);
}

TEST_CASE("A new watch knows nothing of what was before") {
  Replies r(1);
  REQUIRE(r.next_at(r.state.reading_rad + 0.019f, 0.0f) == 0);
  r.watch.start(r.now_ns);
  r.state.reading_rad += 0.5f;  // moved by hand while off
  CHECK(r.next() == 0);
  CHECK(r.next_at(r.state.reading_rad + 0.019f, 0.0f) == 0);
}

TEST_CASE("The torque may be away from what was asked by its bound, on both sides") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    const float bound_Nm = kLimits[joint].following_Nm;
    for (const float side : {1.0f, -1.0f}) {
      for (const bool beyond : {false, true}) {
        Replies r(joint);
        r.gives_way = true;
        const float off_Nm = beyond ? std::nextafter(bound_Nm, 1e9f) : bound_Nm;
        r.passed = {DriveAction::kCommand, {.torque_Nm = 0.0f}};
        r.state.torque_Nm = side * off_Nm;
        for (int i = 1; i < kNotFollowingTicks; ++i) REQUIRE(r.next() == 0);
        CHECK(r.next() == (beyond ? fault::kNotFollowing : 0));
        CHECK(r.look() == 0);  // the same reply is not counted twice
        CHECK(r.next() == (beyond ? fault::kNotFollowing : 0));
      }
    }
  }
}

TEST_CASE("What is asked is the law of the passed command at the reported state") {
  Replies r(1);
  r.passed = {DriveAction::kCommand, {0.02f, 0.5f, 5000.0f, 100.0f, 30.0f}};
  r.state.position_rad = 0.01f;
  r.state.velocity_rad_s = 0.1f;
  r.state.torque_Nm = 120.0f;  // 5000 * 0.01 + 100 * 0.4 + 30
  for (int i = 0; i < 300; ++i) {
    r.state.reading_rad += 1e-4f;
    REQUIRE(r.next() == 0);
  }
  r.state.torque_Nm = 0.0f;
  FaultBits found = 0;
  int ticks = 0;
  for (; found == 0 && ticks < 1000; ++ticks) {
    r.state.reading_rad += 1e-4f;
    found = r.next();
  }
  CHECK(found == fault::kNotFollowing);
  CHECK(ticks == kNotFollowingTicks);
}

TEST_CASE("Moments of lag do not add up, a drive that is off more often than not is found") {
  Replies r(1);
  r.gives_way = true;
  r.passed = {DriveAction::kCommand, {.torque_Nm = 200.0f}};
  for (int i = 0; i < 5000; ++i) {
    r.state.torque_Nm = i % 2 == 0 ? 0.0f : 200.0f;
    REQUIRE(r.next() == 0);
  }
  FaultBits found = 0;
  int ticks = 0;
  for (; found == 0 && ticks < 5000; ++ticks) {
    r.state.torque_Nm = ticks % 3 != 2 ? 0.0f : 200.0f;
    found = r.next();
  }
  // Two up, one down: one more in three ticks. 98 after 3 * 98, then two misses.
  CHECK(ticks == 3 * 98 + 2);
}

TEST_CASE("A drive cannot be asked for more than it has, nor be blamed for not giving it") {
  for (const float side : {1.0f, -1.0f}) {
    for (const std::size_t joint : {std::size_t{0}, std::size_t{1}}) {
      Replies r(joint);
      r.gives_way = true;
      const float peak_Nm = kDrives[joint].peak_torque_Nm;
      r.passed = {DriveAction::kCommand, {.torque_Nm = side * 3.0f * peak_Nm}};
      r.state.torque_Nm = side * peak_Nm;
      for (int i = 0; i < 300; ++i) REQUIRE(r.next() == 0);
      r.state.torque_Nm = side * (peak_Nm - kLimits[joint].following_Nm * 1.01f);
      for (int i = 1; i < kNotFollowingTicks; ++i) REQUIRE(r.next() == 0);
      CHECK(r.next() == fault::kNotFollowing);
    }
  }
}

TEST_CASE("Enter and exit ask for no torque, and end what was counted") {
  for (const DriveAction action : {DriveAction::kEnter, DriveAction::kExit}) {
    Replies r(1);
    r.gives_way = true;
    r.state.torque_Nm = 200.0f;
    r.passed = {action, {}};
    for (int i = 0; i < 300; ++i) REQUIRE(r.next() == 0);
    r.passed = {DriveAction::kCommand, {}};
    for (int i = 1; i < kNotFollowingTicks; ++i) REQUIRE(r.next() == 0);
    r.passed = {action, {}};
    REQUIRE(r.next() == 0);
    r.passed = {DriveAction::kCommand, {}};
    for (int i = 1; i < kNotFollowingTicks; ++i) REQUIRE(r.next() == 0);
    CHECK(r.next() == fault::kNotFollowing);
  }
}
