#include "firmware/control/ground_contact.h"

#include <catch2/catch.hpp>

using namespace hoof::firmware::control;

namespace {

/// Without friction the thresholds are those of the settings; with it: slip_test.cpp.
LegModelSettings frictionless() {
  LegModelSettings settings;
  settings.friction_Nm = 0.0f;
  return settings;
}

struct Rig {
  LegModelSettings model = frictionless();
  LegKinematics kinematics{0.3f, 0.3f};
  LegDynamics dynamics{model};
  GroundContact contact{ContactSettings{}, kinematics, dynamics};

  /// A tick at rest with the sole at z while the sand pushes with `force`.
  const GroundEstimate& tick(float z, PlaneVector force) {
    const LegAngles q = kinematics.angles({0.02f, z}).angles;
    const LegAngles own = dynamics.torque_Nm(q, {}, {});
    const LegAngles sand = kinematics.joint_torque_Nm(q, force);
    return contact.update(q, {}, {}, {own.hip_rad - sand.hip_rad, own.knee_rad - sand.knee_rad},
                          0.001f);
  }
};

}  // namespace

TEST_CASE("In the air there is no contact and no force") {
  Rig rig;
  for (int i = 0; i < 200; ++i) rig.tick(-0.45f, {0, 0});
  CHECK(rig.contact.estimate().valid);
  CHECK_FALSE(rig.contact.estimate().contact);
  CHECK(rig.contact.estimate().force_N.z == Approx(0.0).margin(0.01));
}

TEST_CASE("The force of the sand is found, both components, both signs") {
  for (const PlaneVector force : {PlaneVector{260, 600}, PlaneVector{-100, 300}}) {
    Rig rig;
    for (int i = 0; i < 200; ++i) rig.tick(-0.5f, force);
    CHECK(rig.contact.estimate().force_N.x == Approx(force.x).margin(0.05));
    CHECK(rig.contact.estimate().force_N.z == Approx(force.z).margin(0.05));
    CHECK(rig.contact.estimate().contact);
  }
}

TEST_CASE("Sinkage counts from the height of touch-down, and ends with the contact") {
  Rig rig;
  for (int i = 0; i < 100; ++i) rig.tick(-0.49f, {0, 0});
  // 15 N/mm below -0.5, at 0.1 m/s.
  float z = -0.5f;
  for (int i = 0; i < 300; ++i) {
    z -= 1e-4f;
    rig.tick(z, {0, 15000.0f * (-0.5f - z)});
  }
  CHECK(rig.contact.estimate().contact);
  // The filtered force k v (t - T (1 - exp(-t/T))) passes 25 N at t = 25.9 ms, 2.6 mm deep; a tick
  // is 0.1 mm.
  CHECK(rig.contact.estimate().sinkage_m == Approx(0.0274).margin(0.0002));
  for (int i = 0; i < 100; ++i) rig.tick(z, {0, 0});
  CHECK_FALSE(rig.contact.estimate().contact);
  CHECK(rig.contact.estimate().sinkage_m == 0.0f);
}

TEST_CASE("A push shorter than the hold time is no contact; between the thresholds it holds") {
  Rig rig;
  // Filtered, six ticks of 60 N are above 25 N for three ticks; five make a contact.
  for (int i = 0; i < 6; ++i) rig.tick(-0.5f, {0, 60});
  REQUIRE(rig.contact.estimate().force_N.z > 25.0f);
  CHECK_FALSE(rig.contact.estimate().contact);
  for (int i = 0; i < 100; ++i) rig.tick(-0.5f, {0, 18});
  CHECK_FALSE(rig.contact.estimate().contact);
  for (int i = 0; i < 100; ++i) rig.tick(-0.5f, {0, 30});
  CHECK(rig.contact.estimate().contact);
  for (int i = 0; i < 100; ++i) rig.tick(-0.5f, {0, 18});
  CHECK(rig.contact.estimate().contact);
  for (int i = 0; i < 100; ++i) rig.tick(-0.5f, {0, 8});
  CHECK_FALSE(rig.contact.estimate().contact);
}
