#include "firmware/safety/heat.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/firmware/safety/gate_bench.h"

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
using namespace hoof::firmware::safety::test;
using control::Joint;
using control::JointState;
using control::Mode;

namespace {

void hold(Heat& heat, float torque_Nm, double time_s) {
  const auto ticks = static_cast<int>(std::lround(time_s * 1000.0));
  for (int i = 0; i < ticks; ++i) heat.add(torque_Nm, 1e-3f, 1e-3f);
}

/// Closed form: theta = s - (s - theta_0) exp(-t / tau), s = (T / T_c)^2.
double closed_form(const DriveData& drive, double torque_Nm, double from, double time_s) {
  const double s = std::pow(torque_Nm / drive.continuous_torque_Nm, 2);
  return s - (s - from) * std::exp(-time_s / drive.thermal_time_s());
}

}  // namespace

TEST_CASE("A winding warms and cools as its closed form says, either sign of the torque") {
  // A step of 0.1 s of 300 s makes backward Euler lag by half a step in rate, 0.05 s / 300 s; 1e-3
  // bears that and the rounding of some 10000 steps.
  for (const DriveData& drive : {kToeDrive, kLegDrive}) {
    for (const float share : {1.0f, -1.2f, 0.5f}) {
      Heat heat(drive);
      const float torque_Nm = share * drive.continuous_torque_Nm;
      const double tau_s = drive.thermal_time_s();
      hold(heat, torque_Nm, 0.7 * tau_s);
      const double warm = closed_form(drive, torque_Nm, 0.0, 0.7 * tau_s);
      CHECK(heat.ratio() == Approx(warm).margin(1e-3));
      hold(heat, 0.0f, 0.4 * tau_s);
      CHECK(heat.ratio() == Approx(closed_form(drive, 0.0, warm, 0.4 * tau_s)).margin(1e-3));
    }
  }
}

TEST_CASE("The continuous torque for ever ends at 1, and a float gets there") {
  Heat heat(kLegDrive);
  hold(heat, kLegDrive.continuous_torque_Nm, 12.0 * kLegDrive.thermal_time_s());
  CHECK(heat.ratio() == Approx(1.0).margin(1e-3));
}

TEST_CASE("A rest of any length cools, never by more than in truth") {
  for (const float rest_s : {0.1f, 1.0f, 100.0f, 1e4f, 1e7f}) {
    Heat heat(kToeDrive);
    hold(heat, 12.0f, 200.0);
    const double before = heat.ratio();
    heat.add(0.0f, 0.02f, rest_s);
    const double truth = closed_form(kToeDrive, 0.0, before, rest_s);
    CHECK(heat.ratio() < before);
    CHECK(heat.ratio() >= truth * (1.0 - 1e-6));
    CHECK(heat.ratio() == Approx(before / (1.0 + rest_s / 300.0)));
  }
}

TEST_CASE("Heat is taken in by tenths of a second, none lost on the way") {
  Heat heat(kToeDrive);
  heat.add(18.0f, 0.05f, 0.05f);
  CHECK(heat.ratio() == 0.0f);
  heat.add(-9.0f, 0.02f, 0.05f);
  // (4 * 0.05 + 1 * 0.02) / 300 within 0.1 s.
  const double first = 0.22 / 300.0 / (1.0 + 0.1 / 300.0);
  CHECK(heat.ratio() == Approx(first).epsilon(1e-5));
  heat.add(0.0f, 0.05f, 0.05f);
  CHECK(heat.ratio() == Approx(first).epsilon(1e-5));
  heat.add(0.0f, 0.05f, 0.06f);  // nothing of the first tenth counts again
  CHECK(heat.ratio() == Approx(first / (1.0 + 0.11 / 300.0)).epsilon(1e-5));
}

TEST_CASE("The ceiling falls from the peak at 0.9 to the continuous torque at 1, and stays there") {
  CHECK(heat_ceiling_Nm(kToeDrive, 0.0f, 10.0f) == 10.0f);
  CHECK(heat_ceiling_Nm(kToeDrive, 0.9f, 10.0f) == 10.0f);
  CHECK(heat_ceiling_Nm(kToeDrive, 0.91f, 10.0f) == Approx(9.9f).margin(1e-5));
  CHECK(heat_ceiling_Nm(kToeDrive, 0.95f, 10.0f) == Approx(9.5f).margin(1e-5));
  CHECK(heat_ceiling_Nm(kToeDrive, 0.99f, 10.0f) == Approx(9.1f).margin(1e-5));
  CHECK(heat_ceiling_Nm(kToeDrive, 1.0f, 10.0f) == Approx(9.0f).margin(1e-5));
  CHECK(heat_ceiling_Nm(kToeDrive, 1.5f, 10.0f) == 9.0f);
  CHECK(heat_ceiling_Nm(kLegDrive, 0.95f, 317.0f) == Approx(292.5f).margin(1e-3));
  CHECK(heat_ceiling_Nm(kLegDrive, 2.0f, 317.0f) == 268.0f);
}

TEST_CASE("A toe asked for more than it bears for ever gets what it bears, without overheating",
          "[slow]") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  for (JointState& joint : joints) joint.received = true;
  const auto wish = wish_for(Mode::kReady, 0, control::DriveAction::kCommand, {.torque_Nm = 10.0f});
  float highest = 0.0f;
  int first_lowered_ms = 0;
  float torque_Nm = 0.0f;
  for (int ms = 10; ms <= 4'000'000; ms += 10) {  // every tenth tick is enough
    for (JointState& joint : joints) joint.received_ns = ms * kMillisecond_ns;
    joints[0].torque_Nm = torque_Nm;
    joints[0].reading_rad = ms % 20 == 0 ? 1e-6f : 0.0f;  // an encoder that is not stuck
    REQUIRE(gate.inspect(joints, Mode::kReady, ms * kMillisecond_ns, 1) == 0);
    const Verdict& verdict = gate.check(wish, joints);
    torque_Nm = verdict.torque_Nm[0];
    highest = std::max(highest, gate.heat_ratio(Joint::kToe));
    if (first_lowered_ms == 0 && (verdict.limits[0] & limit::kOverload) != 0) first_lowered_ms = ms;
  }
  CHECK(highest <= 1.0f);
  CHECK(gate.heat_ratio(Joint::kToe) == Approx(1.0f).margin(1e-3));
  CHECK(torque_Nm == Approx(9.0f).margin(0.01));
  CHECK(gate.verdict().limits[0] == limit::kOverload);
  // 10 Nm: s = 1.235; 0.9 is reached after 300 s * ln(1.2346 / 0.3346) = 391.7 s.
  CHECK(first_lowered_ms == Approx(391'700).margin(300));
}

TEST_CASE("A drive that heats itself beyond what it was asked for is an overload, in any mode") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const Mode mode : {Mode::kOff, Mode::kFault, Mode::kEmergencyOff, Mode::kReady}) {
      Watched w;
      const auto which = static_cast<Joint>(joint);
      TorqueGate& gate = w.gate;
      warm_up(gate, joint, 1.0995f, w.now_ms);
      w.now_ms += 1'000'000'000;
      CHECK(w.next(-1, mode) == 0);  // after a long rest
      CHECK(gate.heat_ratio(which) < 0.01f);
      warm_up(gate, joint, 1.0995f, w.now_ms);
      REQUIRE(gate.heat_ratio(which) <= kOverheated);
      w.joints[joint].torque_Nm = 1.6f * kDrives[joint].continuous_torque_Nm;
      control::FaultBits found = 0;
      for (int ms = 0; ms < 10'000 && gate.heat_ratio(which) <= kOverheated; ++ms) {
        REQUIRE(found == 0);
        found = w.next(-1, mode);
      }
      CHECK(found == control::fault::kOverload);
      CHECK(gate.latched());
      // The reset forgets the latch, not the heat.
      gate.reset();
      CHECK_FALSE(gate.latched());
      CHECK(gate.heat_ratio(which) > kOverheated);
      CHECK(w.next(-1, mode) == control::fault::kOverload);
    }
  }
}

TEST_CASE("At its very bound heat is no overload") {
  // A torque and a time that end at the bound to the last bit.
  const auto ratio_after = [](float torque_Nm, std::int64_t elapsed_ns) {
    Heat heat(kToeDrive);
    heat.add(torque_Nm, 0.02f, static_cast<float>(elapsed_ns) * 1e-9f);
    return heat.ratio();
  };
  std::int64_t elapsed_ns = 120'000'000;
  float torque_Nm = 0.0f;
  for (int tries = 0; tries < 50; ++tries) {
    elapsed_ns += 1'000'000;
    torque_Nm = 1157.0f;  // 1.1 = (T / 9)^2 0.02 / 300
    while (ratio_after(torque_Nm, elapsed_ns) > kOverheated && torque_Nm > 1150.0f) {
      torque_Nm -= 0.01f;
    }
    while (ratio_after(torque_Nm, elapsed_ns) < kOverheated && torque_Nm < 1160.0f) {
      torque_Nm = std::nextafter(torque_Nm, 2000.0f);
    }
    if (ratio_after(torque_Nm, elapsed_ns) == kOverheated) break;
  }
  REQUIRE(ratio_after(torque_Nm, elapsed_ns) == kOverheated);
  for (const bool beyond : {false, true}) {
    TorqueGate gate({});
    control::PerJoint<JointState> joints{};
    gate.inspect(joints, Mode::kOff, 1, 1);
    joints[0].received = true;
    joints[0].received_ns = elapsed_ns + 1;
    joints[0].torque_Nm = beyond ? torque_Nm + 0.01f : torque_Nm;
    const control::FaultBits found = gate.inspect(joints, Mode::kOff, elapsed_ns + 1, 1);
    CHECK(found == (beyond ? control::fault::kOverload : 0));
    CHECK((gate.heat_ratio(Joint::kToe) == kOverheated) == !beyond);
  }
}

TEST_CASE("Only a fresh reply heats, and for no longer than drives hold a command") {
  struct Case {
    std::int64_t age_ns;  // of the reply
    std::int64_t elapsed_ns;
    bool received;
    double heated_s;
  };
  const std::int64_t second_ns = 1'000'000'000;
  const Case cases[] = {
      {0, second_ns, true, 0.02},
      {kFreshness_ns, second_ns, true, 0.02},
      {kFreshness_ns + 1, second_ns, true, 0.0},
      {0, second_ns, false, 0.0},
      {0, 150'000'000, true, 0.02},
  };
  for (const Case& c : cases) {
    TorqueGate gate({});
    control::PerJoint<JointState> joints{};
    joints[0].received = c.received;
    joints[0].torque_Nm = 18.0f;
    gate.inspect(joints, Mode::kOff, 0, 1);
    joints[0].received_ns = c.elapsed_ns - c.age_ns;
    gate.inspect(joints, Mode::kOff, c.elapsed_ns, 1);
    const double elapsed_s = 1e-9 * static_cast<double>(c.elapsed_ns);
    const double expected = 4.0 * c.heated_s / 300.0 / (1.0 + elapsed_s / 300.0);
    CHECK(gate.heat_ratio(Joint::kToe) == Approx(expected).epsilon(1e-4).margin(1e-12));
    CHECK(gate.heat_ratio(Joint::kHip) == 0.0f);
    // Short steps heat for all of their time.
    for (int i = 1; i <= 200; ++i) {
      joints[0].received_ns = c.elapsed_ns + i * kMillisecond_ns;
      gate.inspect(joints, Mode::kOff, joints[0].received_ns, 1);
    }
    const double more = c.received ? 4.0 * 0.2 / 300.0 : 0.0;
    CHECK(gate.heat_ratio(Joint::kToe) == Approx(expected + more).epsilon(0.01).margin(1e-12));
  }
}

TEST_CASE("A clock that stands still neither heats nor cools") {
  TorqueGate gate({});
  control::PerJoint<JointState> joints{};
  joints[0].received = true;
  joints[0].torque_Nm = 18.0f;
  joints[0].received_ns = 5'000 * kMillisecond_ns;
  gate.inspect(joints, Mode::kOff, 5'000 * kMillisecond_ns, 1);
  const float before = gate.heat_ratio(Joint::kToe);
  CHECK(before > 0.0f);
  for (int i = 0; i < 1000; ++i) gate.inspect(joints, Mode::kOff, 5'000 * kMillisecond_ns, 1);
  CHECK(gate.heat_ratio(Joint::kToe) == before);
  joints[0].torque_Nm = 0.0f;
  gate.inspect(joints, Mode::kOff, 305'000 * kMillisecond_ns, 1);
  CHECK(gate.heat_ratio(Joint::kToe) == Approx(before / 2.0f).epsilon(1e-3));
}
