// Slip and the errors of what the leg feels: driven and dragged feet, impacts, friction, chatter.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "firmware/control/ground_contact.h"
#include "firmware/control/stance_path.h"

using namespace hoof::firmware::control;

namespace {

constexpr float kDt_s = 0.001f;

/// The sole point moves at a given speed while the sand pushes up with a given force.
struct Rig {
  LegModelSettings model;
  LegKinematics kinematics{0.3f, 0.3f};
  LegDynamics dynamics{model};
  GroundContact contact;
  double x_m = 0.05, z_m = -0.5;

  explicit Rig(ContactSettings s = {}) : contact(s, kinematics, dynamics) {}

  const GroundEstimate& tick(PlaneVector speed_m_s, PlaneVector force_N, LegAngles error_Nm = {}) {
    x_m += double(speed_m_s.x) * kDt_s;
    z_m += double(speed_m_s.z) * kDt_s;
    const LegAngles q = kinematics.angles({float(x_m), float(z_m)}).angles;
    const LegAngles qd = kinematics.joint_velocity_rad_s(q, speed_m_s);
    const LegAngles own = dynamics.torque_Nm(q, qd, {});
    const LegAngles sand = kinematics.joint_torque_Nm(q, force_N);
    return contact.update(q, qd, {},
                          {own.hip_rad - sand.hip_rad + error_Nm.hip_rad,
                           own.knee_rad - sand.knee_rad + error_Nm.knee_rad},
                          kDt_s);
  }
};

LegModelSettings frictionless() {
  LegModelSettings settings;
  settings.friction_Nm = 0.0f;
  return settings;
}

ContactSettings body_speed(float speed_m_s) {
  ContactSettings s;
  s.body_speed_m_s = speed_m_s;
  return s;
}

}  // namespace

TEST_CASE("On a held hip all of the foot's way is slip, and the ratio of a driving foot is one") {
  Rig rig;
  for (int i = 0; i < 50; ++i) rig.tick({-0.3f, 0}, {0, 0});
  CHECK(rig.contact.estimate().slip_m == 0.0f);
  CHECK_FALSE(rig.contact.estimate().slip_valid);
  for (int i = 0; i < 200; ++i) rig.tick({-0.3f, 0}, {200, 400});
  const GroundEstimate& g = rig.contact.estimate();
  REQUIRE(g.contact);
  CHECK(g.slip_valid);
  CHECK(g.slip_ratio == 1.0f);
  // 0.3 m/s for 0.2 s; touch-down is noticed within a tick or two (400 N, 10 ms filter, 70 N).
  CHECK(g.slip_m == Approx(0.06).margin(0.0012));
  // Forward on a held hip: the way back is taken back, and there is no driving ratio.
  for (int i = 0; i < 400; ++i) rig.tick({0.3f, 0}, {200, 400});
  CHECK(g.slip_m == Approx(-0.06).margin(0.0012));
  CHECK_FALSE(g.slip_valid);
  CHECK(g.slip_ratio == 0.0f);
  for (int i = 0; i < 100; ++i) rig.tick({0, 0}, {0, 0});
  CHECK_FALSE(g.contact);
  CHECK(g.slip_m == 0.0f);
}

TEST_CASE(
    "On a moving hip: driving is positive, a foot that stays where it trod zero, braking "
    "negative") {
  struct Case {
    float body_m_s, foot_m_s, ratio;
  };
  const Case cases[] = {{0.2f, -0.4f, 0.5f},
                        {0.3f, -0.3f, 0.0f},
                        {0.1f, -0.4f, 0.75f},
                        {0.4f, -0.3f, -1.0f / 3.0f},
                        {0.5f, -0.2f, -1.0f}};
  for (const Case& c : cases) {
    Rig rig(body_speed(c.body_m_s));
    for (int i = 0; i < 20; ++i) rig.tick({c.foot_m_s, 0}, {0, 0});
    for (int i = 0; i < 200; ++i) rig.tick({c.foot_m_s, 0}, {100, 400});
    const GroundEstimate& g = rig.contact.estimate();
    CAPTURE(c.body_m_s, c.foot_m_s);
    CHECK(g.slip_valid);
    CHECK(g.slip_ratio == Approx(c.ratio).margin(1e-4));
    // Both signs: the way of the sole through the ground, -(foot + body) t.
    const double way_m = -(c.foot_m_s + c.body_m_s) * 0.2;
    CHECK(g.slip_m == Approx(way_m).margin(0.003 * std::abs(c.foot_m_s + c.body_m_s) / 0.3 + 1e-5));
  }
}

TEST_CASE("Below the threshold of speed there is no ratio; around it none that is out of bounds") {
  Rig slow(body_speed(0.01f));
  for (int i = 0; i < 300; ++i) slow.tick({-0.04f, 0}, {0, 400});
  CHECK(slow.contact.estimate().contact);
  CHECK_FALSE(slow.contact.estimate().slip_valid);
  CHECK(slow.contact.estimate().slip_ratio == 0.0f);

  INFO("seed 71");
  std::mt19937 random(71);
  std::uniform_real_distribution<float> speed(-0.4f, 0.1f), body(0.0f, 1.0f);
  for (int run = 0; run < 30; ++run) {
    Rig rig(body_speed(body(random)));
    for (int i = 0; i < 200; ++i) {
      const GroundEstimate& g = rig.tick({speed(random), 0}, {0, 400});
      REQUIRE(g.slip_ratio >= -1.0f);
      REQUIRE(g.slip_ratio <= 1.0f);
      if (!g.slip_valid) REQUIRE(g.slip_ratio == 0.0f);
    }
  }
}

TEST_CASE("Codes of the wire in the speeds shake the ratio by half as much as unfiltered") {
  INFO("seed 72");
  std::mt19937 random(72);
  std::uniform_real_distribution<float> noise(-1.0f, 1.0f);
  Rig rig(body_speed(0.2f));
  float worst = 0.0f;
  for (int i = 0; i < 400; ++i) {
    // Half a code of 0.01 rad/s in both joints, at 0.5 m: 5 mm/s.
    const GroundEstimate& g = rig.tick({-0.4f + 0.005f * noise(random), 0}, {100, 400});
    if (i > 100) worst = std::max(worst, std::abs(g.slip_ratio - 0.5f));
  }
  CHECK(worst > 1e-5f);
  // Unfiltered V / u^2 * 5 mm/s = 0.0063; uniform noise through 20 ticks: 4 sigma of 0.0006.
  CHECK(worst < 0.003f);
}

TEST_CASE("Friction that the model has wrong is a force within the bound, both signs and joints") {
  // J^-T of the joints' standstill friction, either way: over the whole path the sum of the
  // magnitudes of a row. At rest the drives may hold with anything between -4.8 and 4.8 Nm.
  const LegModelSettings model;
  double worst_z_N = 0.0, worst_x_N = 0.0;
  for (int i = 0; i < 200; ++i) {
    StancePath path{PathSettings{}};
    path.reset(float(i) / 200.0f);
    const LegKinematics leg(model.thigh_m, model.shank_m);
    const LegAngles q = leg.angles(path.point().position_m).angles;
    for (const float hip : {-1.0f, 1.0f}) {
      for (const float knee : {-1.0f, 1.0f}) {
        const PlaneVector f =
            leg.foot_force_N(q, {hip * model.friction_Nm, knee * model.friction_Nm});
        worst_z_N = std::max(worst_z_N, std::abs(double(f.z)));
        worst_x_N = std::max(worst_x_N, std::abs(double(f.x)));
      }
    }
  }
  CAPTURE(worst_x_N, worst_z_N);
  CHECK(worst_z_N == Approx(53.2).margin(0.2));
  CHECK(worst_x_N == Approx(18.1).margin(0.2));

  // So neither is an unloaded leg in contact, nor does contact last in the air; at rest with any
  // friction up to that, moving with what is left of it.
  for (const float speed_m_s : {0.0f, -0.1f, 0.1f}) {
    for (const float hip : {-1.0f, 0.0f, 1.0f}) {
      for (const float knee : {-1.0f, 0.0f, 1.0f}) {
        Rig rig;
        const auto tick = [&](float force_N) {
          const LegAngles q = rig.kinematics.angles({float(rig.x_m), -0.5f}).angles;
          const LegAngles v = rig.kinematics.joint_velocity_rad_s(q, {speed_m_s, 0.0f});
          const double f = rig.model.friction_Nm;
          return rig.tick({speed_m_s, 0}, {0, force_N},
                          {float(hip * f * 0.05 / (std::abs(v.hip_rad) + 0.05)),
                           float(knee * f * 0.05 / (std::abs(v.knee_rad) + 0.05))});
        };
        CAPTURE(speed_m_s, hip, knee);
        for (int i = 0; i < 300; ++i) REQUIRE_FALSE(tick(0).contact);
        for (int i = 0; i < 300; ++i) tick(400);
        CHECK(rig.contact.estimate().contact);
        CHECK(rig.contact.estimate().force_N.z == Approx(400.0).margin(worst_z_N));
        for (int i = 0; i < 300; ++i) tick(0);
        CHECK_FALSE(rig.contact.estimate().contact);
      }
    }
  }
}

TEST_CASE("A moving leg feels less than a resting one can: the threshold follows the friction") {
  const auto least_N = [](float speed_m_s) {
    for (float force_N = 10.0f; force_N < 120.0f; force_N += 1.0f) {
      Rig rig;
      for (int i = 0; i < 100; ++i) {
        if (rig.tick({speed_m_s, 0}, {0, force_N}).contact) return force_N;
      }
    }
    return 1e9f;
  };
  CHECK(least_N(-0.3f) < 40.0f);
  CHECK(least_N(0.3f) < 40.0f);
  CHECK(least_N(0.0f) > 60.0f);
  CHECK(least_N(0.0f) < 80.0f);
}

TEST_CASE("An impact and its ringing: one touch-down, and it stays one") {
  Rig rig;
  int touches = 0;
  bool before = false;
  double lowest_N = 1e9;
  for (int i = 0; i < 400; ++i) {
    // A load of 600 N that builds up within 10 ms, 500 N of ringing at 50 Hz on it: down to 60 N,
    // but never off the ground, which would be another touch-down.
    const double t = (i - 50) * 1e-3;
    const double ringing = 500.0 * std::exp(-t / 0.05) * std::sin(2.0 * M_PI * 50.0 * t);
    const double force = i < 50 ? 0.0 : 600.0 * (1.0 - std::exp(-t / 0.003)) + ringing;
    if (i > 50) lowest_N = std::min(lowest_N, force);
    const bool now = rig.tick({-0.2f, 0}, {0, float(force)}).contact;
    if (now && !before) ++touches;
    before = now;
  }
  CHECK(touches == 1);
  CHECK(before);
  CHECK(lowest_N > 0.0);
}

TEST_CASE("A force that shakes by less than the gap of the thresholds makes no contact chatter") {
  const ContactSettings s;
  const float half_N = 0.49f * (s.touch_force_N - s.release_force_N);
  const float middle_N = 0.5f * (s.touch_force_N + s.release_force_N);
  INFO("seed 73");
  std::mt19937 random(73);
  std::uniform_real_distribution<float> shake(-half_N, half_N);
  for (const bool loaded : {false, true}) {
    Rig rig;
    rig.dynamics = LegDynamics(rig.model = frictionless());
    rig.contact = GroundContact(s, rig.kinematics, rig.dynamics);
    for (int i = 0; i < 100; ++i) rig.tick({0, 0}, {0, loaded ? 400.0f : 0.0f});
    for (int i = 0; i < 5000; ++i) {
      REQUIRE(rig.tick({0, 0}, {0, middle_N + shake(random)}).contact == loaded);
    }
  }
}
