#include "sim/coupling/plant.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "sim/multibody/sinkage_rig.h"
#include "sim/multibody/traction_rig.h"
#include "tests/sim/coupling/shipped_plant.h"

using namespace hoof::sim;

namespace {

struct Case {
  std::string foot = "traditional";
  double load_N = 40.0 * kGravity_m_s2;
  double height_m = 1e-3;
  RigidTerrainSettings floor = shipped_floor();
  CouplingSettings coupling = shipped_coupling();
};

struct SinkageCase {
  explicit SinkageCase(const Case& c) {
    SinkageRigSettings settings;
    settings.foot = shipped_foot(c.foot);
    settings.load_N = c.load_N;
    settings.start_height_m = c.height_m;
    auto owned = std::make_unique<SinkageRig>(settings);
    rig = owned.get();
    plant = std::make_unique<Plant>(std::move(owned), shipped_drives(),
                                    std::make_unique<RigidTerrain>(c.floor), c.coupling);
  }

  void run(double time_s) {
    const auto steps = std::lround(time_s / plant->settings().exchange_s);
    for (int i = 0; i < steps; ++i) plant->advance();
  }

  SinkageRig* rig;
  std::unique_ptr<Plant> plant;
};

/// A linear spring that answers with the mean over the interval, as a ground that is itself
/// stepped does. Where it passes that off as the wrench at the end, the lag of half an interval
/// acts like a damper of -k h / 2.
class LateSpring final : public Terrain {
 public:
  explicit LateSpring(WrenchTime claimed) : claimed_(claimed) {}
  WrenchTime wrench_time() const override { return claimed_; }
  int add_body(const TriangleMesh&, const Pose&) override { return 0; }
  void advance(double, std::span<const BodyMotion> motions, std::span<Wrench> wrenches) override {
    const double before = -kStiffness_N_m * motions[0].start.p_WB_m.z();
    const double now = -kStiffness_N_m * motions[0].end.p_WB_m.z();
    const double mean = 0.5 * (before + now);
    work_J_ += mean * (motions[0].end.p_WB_m.z() - motions[0].start.p_WB_m.z());
    wrenches[0] = {{0.0, 0.0, mean}, Eigen::Vector3d::Zero()};
  }
  double surface_height_m() const override { return 0.0; }
  double work_on_bodies_J() const override { return work_J_; }
  static constexpr double kStiffness_N_m = 1e5;

 private:
  WrenchTime claimed_;
  double work_J_ = 0.0;
};

/// Vertices in the plane that touches first.
int lowest_vertices(const TriangleMesh& mesh) {
  double lowest = 1.0;
  for (const auto& v : mesh.vertices_m) lowest = std::min(lowest, v.z());
  return static_cast<int>(std::count_if(mesh.vertices_m.begin(), mesh.vertices_m.end(),
                                        [&](const auto& v) { return v.z() < lowest + 1e-9; }));
}

}  // namespace

TEST_CASE("a loaded foot comes to rest on the floor where stiffness carries the load") {
  Case c;
  c.foot = GENERATE("traditional", "bionic", "bionic-plain");
  c.height_m = c.foot == "bionic" ? 0.0104 : 0.001;  // the spines' tips are 9.4 mm below the sole
  SinkageCase s(c);
  s.rig->lower(0.1);
  while (!s.plant->touched()) s.plant->advance();
  s.rig->release();
  s.run(0.5);
  int vertices = 0;
  double lowest = 0.0;
  for (int body = 0; body < s.rig->body_count(); ++body) {
    vertices += lowest_vertices(s.rig->mesh(body));
    for (const auto& v : s.rig->mesh(body).vertices_m) lowest = std::min(lowest, v.z());
  }
  const double depth_m = c.load_N / (vertices * c.floor.stiffness_N_m);
  // Hinges of the toes give way by nanometres; the rest is rounding.
  CHECK(s.rig->foot_position_m().z() == Approx(-lowest - depth_m).margin(1e-7));
  CHECK(s.plant->ground_force_N().z() == Approx(c.load_N).epsilon(1e-6));
  CHECK(s.rig->foot_velocity_m_s().norm() < 1e-6);
}

TEST_CASE("an impact never makes energy: the foot rebounds, but never higher than it came from") {
  Case c;
  c.floor.damping_N_s_m = GENERATE(0.0, 20.0);
  SinkageCase s(c);
  s.rig->release();
  // The load of 392 N on 1.5 kg falls 1 mm: 0.39 J. Height is measured while it bounces.
  double apex_m = 1e-3;
  int bounces = 0;
  double last_v = 0.0;
  while (bounces < 10) {
    s.plant->advance();
    const double v = s.rig->foot_velocity_m_s().z();
    if (last_v > 0.0 && v <= 0.0 && s.plant->ground_force_N().z() == 0.0) {
      const double height_m = s.rig->foot_position_m().z();
      // 0.5 % of the height: the step resolves the half swing on the floor (1.7 ms) into 35 parts.
      CHECK(height_m < apex_m + 5e-6);
      if (c.floor.damping_N_s_m > 0.0) CHECK(height_m < apex_m);
      apex_m = height_m;
      ++bounces;
    }
    last_v = v;
    if (s.plant->time_s() > 0.5) break;
  }
  if (c.floor.damping_N_s_m == 0.0) {
    CHECK(bounces == 10);
    CHECK(apex_m > 0.95e-3);  // and none is lost either, without damping
  }
  // What the floor gave the rig has got: 0.39 J each way, 10 times.
  CHECK(std::abs(s.plant->exchange_energy().error_J()) < 1e-3);
}

namespace {

struct Bounce {
  double energy_ratio;  // greatest kinetic energy over that at the start
  double error_J;       // as the plant tells it
};

/// 1.5 kg oscillate on the spring for half a second.
Bounce oscillate(WrenchTime claimed) {
  SinkageRigSettings settings;
  settings.foot = shipped_foot("traditional");
  settings.load_N = 1e-9;
  auto owned = std::make_unique<SinkageRig>(settings);
  SinkageRig& rig = *owned;
  rig.lower(0.1);
  Plant plant(std::move(owned), {}, std::make_unique<LateSpring>(claimed), shipped_coupling());
  plant.advance();
  rig.release();
  double most_m_s = 0.0;
  while (plant.time_s() < 0.5) {
    plant.advance();
    most_m_s = std::max(most_m_s, std::abs(rig.foot_velocity_m_s().z()));
  }
  return {most_m_s * most_m_s / 0.01, plant.exchange_energy().error_J()};
}

}  // namespace

TEST_CASE("a force that comes half an interval late makes energy, and the plant says how much") {
  const Bounce bounce = oscillate(WrenchTime::kEndOfInterval);
  // Energy grows as exp(k h / (2 m) t): 1.67 /s, 2.30 times after 0.5 s.
  const double growth = std::exp(1e5 * 50e-6 / (2.0 * 1.5) * 0.5);
  CHECK(bounce.energy_ratio == Approx(growth).epsilon(0.02));
  CHECK(bounce.error_J == Approx(0.5 * 1.5 * 0.01 * (growth - 1.0)).epsilon(0.05));
}

TEST_CASE("a mean over the interval that is known as such makes no energy") {
  const Bounce bounce = oscillate(WrenchTime::kMeanOverInterval);
  // What is left is of second order, (w h)^2 = 1.7e-4 of a swing's energy at w = 258 rad/s.
  CHECK(bounce.energy_ratio == Approx(1.0).margin(5e-3));
  CHECK(std::abs(bounce.error_J) < 5e-3 * 0.5 * 1.5 * 0.01);
}

TEST_CASE("halving the exchange interval changes the deepest point by less than 1 %") {
  const auto deepest_m = [](double exchange_s) {
    Case c;
    c.coupling.exchange_s = exchange_s;
    SinkageCase s(c);
    s.rig->lower(0.1);
    while (!s.plant->touched()) s.plant->advance();
    s.rig->release();
    double deepest = 0.0;
    while (s.plant->time_s() < 0.1) {
      s.plant->advance();
      deepest = std::min(deepest, s.rig->foot_position_m().z());
    }
    return deepest;
  };
  CHECK(deepest_m(50e-6) == Approx(deepest_m(25e-6)).epsilon(0.01));
}

TEST_CASE("a foot beyond the speed limit is stopped by name") {
  Case c;
  c.coupling.speed_limit_m_s = 0.05;
  SinkageCase s(c);
  s.plant->advance();
  s.rig->lower(0.1);
  CHECK_THROWS_WITH(s.plant->advance(),
                    Catch::Contains("the foot moves at 0.1 m/s, above coupling.speed_limit_m_s = "
                                    "0.05"));
}

TEST_CASE("the ground sleeps until the foot is near for the first time") {
  Case c;
  c.height_m = 0.008;
  SinkageCase s(c);
  s.rig->lower(0.1);
  s.plant->advance();
  CHECK(s.plant->terrain_asleep());
  while (s.plant->terrain_asleep()) s.plant->advance();
  CHECK(s.rig->foot_position_m().z() == Approx(c.coupling.sleep_margin_m).margin(2 * 5e-6));
  CHECK_FALSE(s.plant->touched());
  // Awake, it stays so, however far the foot goes.
  s.rig->lower(-0.1);
  s.run(0.1);
  CHECK_FALSE(s.plant->terrain_asleep());
}

TEST_CASE("a sleeping ground is not stepped, and wakes with the way of one interval") {
  struct CountingGround final : Terrain {
    int add_body(const TriangleMesh&, const Pose&) override { return 0; }
    void advance(double, std::span<const BodyMotion> motions, std::span<Wrench>) override {
      ++steps;
      way_m = motions[0].start.p_WB_m.z() - motions[0].end.p_WB_m.z();
    }
    double surface_height_m() const override { return 0.0; }
    double work_on_bodies_J() const override { return 0.0; }
    int steps = 0;
    double way_m = 0.0;
  };
  SinkageRigSettings settings;
  settings.foot = shipped_foot("traditional");
  settings.load_N = 100.0;
  settings.start_height_m = 0.006;
  auto rig = std::make_unique<SinkageRig>(settings);
  rig->lower(0.1);
  auto ground = std::make_unique<CountingGround>();
  const CountingGround& counter = *ground;
  Plant plant(std::move(rig), {}, std::move(ground), shipped_coupling());
  for (int i = 0; i < 150; ++i) plant.advance();  // 0.75 mm down, 5.25 mm above the ground
  CHECK(counter.steps == 0);
  for (int i = 0; i < 100; ++i) plant.advance();
  CHECK(counter.steps == Approx(50).margin(1));
  CHECK(counter.way_m == Approx(5e-6).epsilon(1e-6));
}

TEST_CASE("a diverging exchange is stopped with the cause and the setting to change") {
  Case c;
  c.floor.stiffness_N_m = 1e8;  // 24 vertices on 1.5 kg: 40,000 rad/s, 2 per step
  c.floor.damping_N_s_m = 0.0;
  SinkageCase s(c);
  s.rig->lower(0.1);
  while (!s.plant->touched()) s.plant->advance();
  s.rig->release();
  CHECK_THROWS_WITH(s.run(0.5), Catch::StartsWith("diverged at 0.0") &&
                                    Catch::Contains("shorten coupling.exchange_us (now 50)"));
}

TEST_CASE("the toe drive opens the toes, holds them against the sand, and gives way without gain") {
  Case c;
  c.foot = "bionic-plain";
  c.height_m = 0.1;
  SinkageCase s(c);
  Drive& toe = *s.plant->drive(Joint::kToe);
  CHECK(s.plant->drive(Joint::kHip) == nullptr);
  const double target_rad = 20.0 * M_PI / 180.0;
  const auto push = [&s](double torque_Nm) {
    // The same closing torque on both toes.
    s.rig->apply_wrench(1, {{0, 0, 0}, s.rig->pose(1).q_WB * Eigen::Vector3d(0, 0, -torque_Nm)});
    s.rig->apply_wrench(2, {{0, 0, 0}, s.rig->pose(2).q_WB * Eigen::Vector3d(0, 0, torque_Nm)});
  };
  const auto run = [&](double kp, double torque_Nm, double time_s) {
    for (int i = 0; i < std::lround(time_s / 50e-6); ++i) {
      if (i % 20 == 0) toe.command({target_rad, 0.0, kp, 4.0, 0.0});
      push(torque_Nm);
      s.plant->advance();
    }
    return (target_rad - s.rig->joint_position_rad(Joint::kToe)) * 180.0 / M_PI;
  };
  toe.enable();
  run(200.0, 0.0, 0.5);
  CHECK(s.rig->joint_position_rad(Joint::kToe) == Approx(target_rad).margin(0.003));
  // 2 Nm on each toe: 4 Nm less at most 0.48 Nm of friction, on kp and the gear in series.
  const double held_deg = run(200.0, 2.0, 0.5);
  CHECK(held_deg > (4.0 - 0.49) / 200.0 * 180.0 / M_PI);
  CHECK(held_deg < (4.0 / 200.0 + 4.0 / 2500.0) * 180.0 / M_PI + 0.02);
  const double half_deg = run(100.0, 2.0, 0.5);
  CHECK(half_deg / held_deg == Approx(2.0).margin(0.25));
  CHECK(run(0.0, 2.0, 0.5) > 5.0);
}

TEST_CASE("hip and knee drives hold the leg's weight with the deflection of their law") {
  TractionRigSettings settings;
  settings.foot = shipped_foot("traditional");
  settings.leg = shipped_leg();
  settings.start_x_m = 0.1;
  settings.start_z_m = 0.1;
  auto owned = std::make_unique<TractionRig>(settings);
  TractionRig& rig = *owned;
  Plant plant(std::move(owned), shipped_drives(), std::make_unique<RigidTerrain>(shipped_floor()),
              shipped_coupling());
  const double hip = rig.joint_position_rad(Joint::kHip);
  const double knee = rig.joint_position_rad(Joint::kKnee);
  plant.drive(Joint::kHip)->enable();
  plant.drive(Joint::kKnee)->enable();
  CHECK(plant.drive(Joint::kToe) == nullptr);
  for (int i = 0; i < 20000; ++i) {
    if (i % 20 == 0) {
      plant.drive(Joint::kHip)->command({hip, 0.0, 2000.0, 60.0, 0.0});
      plant.drive(Joint::kKnee)->command({knee, 0.0, 2000.0, 60.0, 0.0});
    }
    plant.advance();
  }
  CHECK(rig.foot_velocity_m_s().norm() < 1e-3);
  for (const Joint joint : {Joint::kHip, Joint::kKnee}) {
    const Drive& drive = *plant.drive(joint);
    const double commanded = joint == Joint::kHip ? hip : knee;
    // The law's torque, and what reaches the joint: within the Coulomb friction of 4.8 Nm.
    CHECK(drive.reading().torque_Nm ==
          Approx(2000.0 * (commanded - drive.reading().position_rad)).margin(0.5));
    CHECK(std::abs(plant.joint_torque_Nm(joint) - drive.reading().torque_Nm) < 4.9);
    CHECK(std::abs(plant.joint_torque_Nm(joint)) > 0.5);
  }
}

TEST_CASE("the same plant run twice gives the same bits") {
  const auto run_once = [] {
    Case c;
    c.foot = "bionic";
    c.height_m = 0.0104;
    SinkageCase s(c);
    s.plant->drive(Joint::kToe)->enable();
    s.plant->drive(Joint::kToe)->command({0.2, 0.0, 200.0, 4.0, 0.0});
    s.rig->lower(0.1);
    s.run(0.02);
    s.rig->release();
    s.run(0.05);
    return std::array<double, 2>{s.rig->foot_position_m().z(), s.plant->ground_force_N().z()};
  };
  const auto a = run_once();
  const auto b = run_once();
  CHECK(std::memcmp(a.data(), b.data(), sizeof a) == 0);
}
