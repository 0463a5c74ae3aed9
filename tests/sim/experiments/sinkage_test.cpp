#include "sim/experiments/sinkage.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/config/config_error.h"
#include "tests/sim/coupling/shipped_plant.h"
#include "tests/sim/experiments/read_section.h"

using namespace hoof::sim;
using hoof::tests::read_section;

namespace {

constexpr double kExchange_s = 50e-6;

SinkageSettings light_settings() {
  SinkageSettings s;
  s.load_N = 100;
  s.speed_m_s = 0.1;
  s.start_height_m = 0.003;
  s.rest_speed_m_s = 0.005;
  s.rest_time_s = 0.03;
  s.time_limit_s = 1;
  return s;
}

/// On the shipped hard floor, damped enough to come to rest.
std::unique_ptr<Sinkage> on_floor(const SinkageSettings& settings, double damping_N_s_m = 50) {
  SinkageRigSettings rig;
  rig.foot = shipped_foot("traditional");
  rig.load_N = settings.load_N;
  rig.load_as = settings.load_as;
  rig.start_height_m = settings.start_height_m;
  RigidTerrainSettings floor = shipped_floor();
  floor.damping_N_s_m = damping_N_s_m;
  return std::make_unique<Sinkage>(
      settings, std::make_unique<Plant>(std::make_unique<SinkageRig>(rig), DriveSet{},
                                        std::make_unique<RigidTerrain>(floor), shipped_coupling()));
}

void run_to(Sinkage& test, Phase phase) {
  while (test.phase() != phase) {
    test.advance();
    REQUIRE(test.time_s() < 5);
  }
}

constexpr char kSinkage[] = R"(load_kg = 40
load_as = "force"
speed_m_s = 0.1
toe_deg = 20
start_height_mm = 20
rest_speed_mm_s = 5
rest_time_ms = 30
time_limit_s = 2
)";

SinkageSettings read(const std::string& toml) {
  return read_section(toml, "sinkage.toml",
                      [](const Reader& section) { return read_sinkage(section); });
}

}  // namespace

TEST_CASE("the foot is held until it is ready, lowered at its speed, then let go") {
  SinkageSettings settings = light_settings();
  settings.speed_m_s = GENERATE(0.1, 0.4);
  const auto test = on_floor(settings);
  for (int i = 0; i < 1000; ++i) test->advance();
  CHECK(test->phase() == Phase::kPreparing);
  CHECK(test->plant().rig().foot_position_m().z() == Approx(0.003).margin(1e-9));
  CHECK(test->progress() == 0);

  test->foot_ready();
  CHECK(test->phase() == Phase::kLowering);
  const double start_s = test->time_s();
  double speed_m_s = 0;
  while (test->phase() == Phase::kLowering) {
    CHECK(test->observe().depth_m == 0);
    test->advance();
    speed_m_s = -test->plant().rig().foot_velocity_m_s().z();
  }
  // Found within the exchange in which it happens: one interval's way is 5 or 20 um.
  CHECK(test->phase() == Phase::kLoaded);
  CHECK(speed_m_s == Approx(settings.speed_m_s).epsilon(1e-9));
  CHECK(test->time_s() - start_s == Approx(0.003 / settings.speed_m_s).margin(2 * kExchange_s));
  CHECK(test->observe().depth_m == Approx(0).margin(1e-12));
  // Free from now on: load and floor, and no carriage, change its speed.
  test->advance();
  const double force_N = test->plant().ground_force_N().z();
  CHECK(force_N > 0);
  const double before_m_s = test->plant().rig().foot_velocity_m_s().z();
  test->advance();
  const double after_m_s = test->plant().rig().foot_velocity_m_s().z();
  CHECK((after_m_s - before_m_s) / kExchange_s == Approx((force_N - 100) / 1.5).epsilon(1e-6));
}

TEST_CASE("depth counts from first contact, its maximum is kept, and the test ends at rest") {
  const auto test = on_floor(light_settings());
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  const double contact_z_m = test->plant().rig().foot_position_m().z();
  double deepest_m = 0;
  while (!test->finished()) {
    test->advance();
    deepest_m = std::max(deepest_m, contact_z_m - test->plant().rig().foot_position_m().z());
  }
  CHECK(test->rested());
  CHECK(test->max_depth_m() == deepest_m);
  CHECK(test->final_depth_m() ==
        Approx(contact_z_m - test->plant().rig().foot_position_m().z()).margin(1e-15));
  CHECK(test->max_depth_m() > test->final_depth_m());
  CHECK(test->plant().ground_force_N().z() == Approx(100).epsilon(0.2));
  CHECK(test->progress() == 1);
  CHECK(test->time_s() < 1);
}

TEST_CASE("rest needs its whole time below the speed: a turning point is no rest") {
  // Without damping the foot swings on the floor for ever, at speed zero twice a swing.
  SinkageSettings settings = light_settings();
  settings.time_limit_s = 0.2;
  const auto test = on_floor(settings, 0);
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  const double contact_s = test->time_s();
  run_to(*test, Phase::kFinished);
  CHECK_FALSE(test->rested());
  CHECK(test->time_s() - contact_s == Approx(0.2).margin(1.5 * kExchange_s));
}

TEST_CASE("rest is called one rest time after the last fast moment") {
  SinkageSettings settings = light_settings();
  settings.rest_time_s = GENERATE(0.01, 0.1);
  const auto test = on_floor(settings);
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  double fast_s = 0;
  while (!test->finished()) {
    test->advance();
    if (std::abs(test->plant().rig().foot_velocity_m_s().z()) > 0.005) fast_s = test->time_s();
  }
  CHECK(test->time_s() - fast_s == Approx(settings.rest_time_s).margin(1.5 * kExchange_s));
}

TEST_CASE("a foot that arrives slower than the rest speed still gets its rest time on the ground") {
  SinkageSettings settings = light_settings();
  settings.speed_m_s = 0.002;
  settings.start_height_m = 0.001;
  settings.rest_speed_m_s = 0.1;  // never exceeded: the load on these springs gives 0.05 m/s
  const auto test = on_floor(settings);
  for (int i = 0; i < 1000; ++i) test->advance();
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  const double contact_s = test->time_s();
  run_to(*test, Phase::kFinished);
  CHECK(test->rested());
  CHECK(test->time_s() - contact_s == Approx(0.03).margin(1.5 * kExchange_s));
}

TEST_CASE("a load as a force moves the foot alone, as a mass the block too") {
  const auto [load_as, mass_kg] = GENERATE(
      table<LoadAs, double>({{LoadAs::kForce, 1.5}, {LoadAs::kMass, 100 / kGravity_m_s2}}));
  SinkageSettings settings = light_settings();
  settings.load_as = load_as;
  const auto test = on_floor(settings, 0);
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  // Constant force and linear springs: the deepest point of a fall at v0 onto stiffness k is
  // F/k + sqrt((F/k)^2 + m v0^2 / k), from where the springs begin.
  int vertices = 0;
  const TriangleMesh& mesh = test->plant().rig().mesh(0);
  for (const auto& v : mesh.vertices_m) vertices += v.z() < 1e-9;
  const double k_N_m = vertices * shipped_floor().stiffness_N_m;
  const double rest_m = 100 / k_N_m;
  const double deepest_m = rest_m + std::sqrt(rest_m * rest_m + mass_kg * 0.01 / k_N_m);
  double z_m = 0;
  for (int i = 0; i < 2000; ++i) {
    test->advance();
    z_m = std::min(z_m, test->plant().rig().foot_position_m().z());
  }
  // 5 um of way in one exchange, within which the contact begins.
  CHECK(-z_m == Approx(deepest_m).margin(6e-6));
}

TEST_CASE("what is observed is the mean over the tick and begins anew") {
  const auto test = on_floor(light_settings());
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  test->observe();
  double sum_N = 0;
  for (int i = 0; i < 20; ++i) {
    test->advance();
    sum_N += test->plant().ground_force_N().z();
  }
  const Observation o = test->observe();
  CHECK(o.ground_N.z() == Approx(sum_N / 20));
  CHECK(o.phase == Phase::kLoaded);
  CHECK(o.time_s == test->time_s());
  CHECK(o.sink_speed_m_s == -test->plant().rig().foot_velocity_m_s().z());
  CHECK(test->observe().ground_N.norm() == 0);
}

TEST_CASE("progress never falls") {
  const auto test = on_floor(light_settings());
  test->foot_ready();
  double last = 0;
  while (!test->finished()) {
    test->advance();
    REQUIRE(test->progress() >= last);
    last = test->progress();
  }
  CHECK(last == 1);
}

TEST_CASE("being ready twice changes nothing") {
  const auto test = on_floor(light_settings());
  test->foot_ready();
  run_to(*test, Phase::kLoaded);
  test->foot_ready();
  CHECK(test->phase() == Phase::kLoaded);
}

TEST_CASE("the settings of a sinkage test arrive in SI") {
  const SinkageSettings s = read(kSinkage);
  CHECK(s.load_N == Approx(40 * 9.81).epsilon(1e-12));
  CHECK(s.load_as == LoadAs::kForce);
  CHECK(s.speed_m_s == 0.1);
  CHECK(s.toe_rad == Approx(20 * M_PI / 180));
  CHECK(s.start_height_m == 0.02);
  CHECK(s.rest_speed_m_s == 0.005);
  CHECK(s.rest_time_s == 0.03);
  CHECK(s.time_limit_s == 2);
  std::string mass = kSinkage;
  mass.replace(mass.find("\"force\""), 7, "\"mass\"");
  CHECK(read(mass).load_as == LoadAs::kMass);
}

TEST_CASE("a load in newtons wins over one in kilograms") {
  CHECK(read(kSinkage + std::string("load_N = 400\n")).load_N == 400);
}

TEST_CASE("a wrong setting of a sinkage test is refused with file, line, key and bound") {
  const auto refusal = [](const std::string& old_text, const std::string& new_text) -> std::string {
    std::string toml = kSinkage;
    toml.replace(toml.find(old_text), old_text.size(), new_text);
    try {
      read(toml);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "accepted";
  };
  using Catch::Contains;
  CHECK_THAT(refusal("load_kg = 40", "load_kg = -40"),
             Contains("sinkage.toml:1:") && Contains("load_kg = -40") && Contains("0.01"));
  CHECK_THAT(refusal("load_kg = 40", "load_kg = 40\nload_N = 0"),
             Contains("sinkage.toml:2:") && Contains("load_N = 0") && Contains("0.1"));
  CHECK_THAT(refusal("toe_deg = 20", "toe_deg = 55"),
             Contains("sinkage.toml:4:") && Contains("toe_deg = 55") && Contains("40"));
  CHECK_THAT(refusal("speed_m_s = 0.1", "speed_mm_s = 100"),
             Contains("sinkage.toml:3:") && Contains("speed_mm_s") && Contains("speed_m_s"));
  CHECK_THAT(refusal("\"force\"", "\"weight\""),
             Contains("sinkage.toml:2:") && Contains("load_as = \"weight\"") && Contains("mass"));
  CHECK_THAT(refusal("rest_time_ms = 30\n", ""), Contains("rest_time_ms"));
}
