#include "sim/experiments/traction.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "sim/config/config_error.h"
#include "tests/sim/coupling/shipped_plant.h"
#include "tests/sim/experiments/read_section.h"

using namespace hoof::sim;
using hoof::tests::read_section;

namespace {

constexpr StanceEllipse kPath{0.1, 0.04, 0.005};

TractionSettings prescribed_settings(double centre_height_m) {
  TractionSettings s;
  s.frequency_Hz = 2;
  s.ellipse = kPath;
  s.ellipse.centre_height_m = centre_height_m;
  s.prescribed = true;
  return s;
}

std::unique_ptr<Traction> on_floor(const TractionSettings& settings) {
  auto rig = std::make_unique<PrescribedRig>(shipped_foot("traditional"), shipped_leg(),
                                             settings.ellipse.at(0));
  return std::make_unique<Traction>(
      settings,
      std::make_unique<Plant>(std::move(rig), DriveSet{},
                              std::make_unique<RigidTerrain>(shipped_floor()), shipped_coupling()));
}

constexpr char kTraction[] = R"(drive = "firmware"
frequency_Hz = 0.45
toe_deg = 10
ellipse_half_length_mm = 100
ellipse_half_height_mm = 40
ellipse_centre_height_mm = 5
cycles = 2
)";

TractionSettings read(const std::string& toml) {
  return read_section(toml, "traction.toml",
                      [](const Reader& section) { return read_traction(section); });
}

}  // namespace

TEST_CASE("the ellipse runs from its top forward and down, and back through its lower half") {
  CHECK(kPath.at(0).x_m == 0);
  CHECK(kPath.at(0).z_m == Approx(0.045));
  CHECK(kPath.at(0.25).x_m == Approx(0.1));
  CHECK(kPath.at(0.25).z_m == Approx(0.005));
  CHECK(kPath.at(0.5).x_m == Approx(0).margin(1e-15));
  CHECK(kPath.at(0.5).z_m == Approx(-0.035));
  CHECK(kPath.at(0.75).x_m == Approx(-0.1));
  CHECK(kPath.at(1.3).x_m == Approx(kPath.at(0.3).x_m));
  for (double turns = 0.26; turns < 0.75; turns += 0.01) {
    CHECK(kPath.at(turns).z_m < 0.005);
    CHECK(kPath.at(turns).x_m < kPath.at(turns - 0.01).x_m);
  }
}

TEST_CASE("distance from the ellipse: on it, on the axes, at its centre") {
  for (double turns = 0; turns < 1; turns += 0.037) {
    // Golden section finds a minimum to about the square root of rounding: 1e-8 of 0.1 m.
    CHECK(kPath.distance_m(kPath.at(turns)) < 1e-8);
  }
  for (const double sign : {-1.0, 1.0}) {
    CHECK(kPath.distance_m({0, 0.005 + sign * 0.06}) == Approx(0.02));
    CHECK(kPath.distance_m({sign * 0.13, 0.005}) == Approx(0.03));
    CHECK(kPath.distance_m({0, 0.005 + sign * 0.03}) == Approx(0.01));
  }
  CHECK(kPath.distance_m({0, 0.005}) == Approx(0.04));
  // Inside on the long axis the nearest point is beside, not ahead:
  // b sqrt(1 - x^2 / (a^2 - b^2)) for |x| < (a^2 - b^2) / a.
  CHECK(kPath.distance_m({0.05, 0.005}) ==
        Approx(0.04 * std::sqrt(1 - 0.05 * 0.05 / (0.01 - 0.0016))));
}

TEST_CASE("distance from the ellipse is that of the nearest of very many points") {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 50; ++i) {
    const StanceEllipse path{0.02 + 0.2 * unit(random), 0.01 + 0.1 * unit(random), 0.02};
    const FootPoint p{0.5 * unit(random) - 0.25, 0.3 * unit(random) - 0.15};
    INFO("seed " << seed << ", half axes " << path.half_length_m << " " << path.half_height_m
                 << ", point " << p.x_m << " " << p.z_m);
    double nearest = 1;
    constexpr int kPoints = 20000;
    for (int k = 0; k < kPoints; ++k) {
      const FootPoint q = path.at(double(k) / kPoints);
      nearest = std::min(nearest, std::hypot(p.x_m - q.x_m, p.z_m - q.z_m));
    }
    // The points are up to 70 um apart: their nearest is at most that much too far.
    const double distance = path.distance_m(p);
    CHECK(distance <= nearest + 1e-12);
    CHECK(distance > nearest - 70e-6);
  }
}

TEST_CASE("a prescribed foot stands until it is ready, then follows the path from its top") {
  const auto test = on_floor(prescribed_settings(0.2));
  for (int i = 0; i < 100; ++i) test->advance();
  CHECK(test->plant().rig().foot_position_m().z() == Approx(0.24));
  CHECK(test->progress() == 0);
  test->foot_ready();
  const double start_s = test->time_s();
  // Run-up over a tenth of a turn at constant acceleration: twice the time of a tenth at speed.
  const auto turns = [](double t_s) {
    return t_s < 0.1 ? 0.5 * 2 * t_s * t_s / 0.1 : 0.1 + 2 * (t_s - 0.1);
  };
  const StanceEllipse path = prescribed_settings(0.2).ellipse;
  double last_x = 0;
  for (int i = 0; i < 8000; ++i) {
    test->advance();
    const FootPoint want = path.at(turns(test->time_s() - start_s));
    const Eigen::Vector3d is = test->plant().rig().foot_position_m();
    REQUIRE(is.x() == Approx(want.x_m).margin(1e-9));
    REQUIRE(is.z() == Approx(want.z_m).margin(1e-9));
    REQUIRE(std::abs(is.x() - last_x) < 0.1 * 2 * M_PI * 2 * 50e-6 * 1.001);  // never faster
    last_x = is.x();
  }
}

TEST_CASE("a gait that never touches the ground ends by its time-out") {
  const auto test = on_floor(prescribed_settings(0.2));
  test->foot_ready();
  while (!test->finished()) {
    test->advance();
    REQUIRE(test->time_s() < 10);
  }
  // (1 + 1.5) turns of 0.5 s and 2 s.
  CHECK(test->time_s() == Approx(3.25).margin(2e-4));
  CHECK(test->max_depth_m() == 0);
  CHECK(test->progress() == 1);
}

TEST_CASE("a stance begins at contact, ends when the foot has left, and every cycle is one") {
  // Short, so that the foot hardly pitches, and 1 mm into a floor of springs.
  TractionSettings settings = prescribed_settings(0);
  settings.ellipse = {0.02, 0.02, 0.019};
  settings.cycles = GENERATE(1, 2);
  const auto test = on_floor(settings);
  test->foot_ready();
  CHECK(test->phase() == Phase::kPreparing);
  int contacts = 0;
  bool touching = false;
  double left_s = 0, last = 0;
  while (!test->finished()) {
    test->advance();
    const bool now = test->plant().ground_force_N().norm() > 2;
    contacts += now && !touching;
    if (touching && !now) left_s = test->time_s();
    touching = now;
    if (now) CHECK(test->phase() == Phase::kLoaded);
    REQUIRE(test->progress() >= last);
    last = test->progress();
    REQUIRE(test->time_s() < 5);
  }
  CHECK(contacts == settings.cycles);
  // 50 ms without a touch mean that it has left.
  CHECK(test->time_s() - left_s == Approx(0.05).margin(2e-4));
  CHECK(test->max_depth_m() == Approx(0.001).epsilon(1e-3));
}

TEST_CASE("the settings of a traction test arrive in SI") {
  const TractionSettings s = read(kTraction);
  CHECK_FALSE(s.prescribed);
  CHECK(s.frequency_Hz == 0.45);
  CHECK(s.toe_rad == Approx(10 * M_PI / 180));
  CHECK(s.ellipse.half_length_m == 0.1);
  CHECK(s.ellipse.half_height_m == 0.04);
  CHECK(s.ellipse.centre_height_m == 0.005);
  CHECK(s.cycles == 2);
  std::string other = kTraction;
  other.replace(other.find("\"firmware\""), 10, "\"prescribed\"");
  CHECK(read(other).prescribed);
}

TEST_CASE("a wrong setting of a traction test is refused with file, line, key and bound") {
  const auto refusal = [](const std::string& old_text, const std::string& new_text) -> std::string {
    std::string toml = kTraction;
    toml.replace(toml.find(old_text), old_text.size(), new_text);
    try {
      read(toml);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "accepted";
  };
  using Catch::Contains;
  CHECK_THAT(refusal("frequency_Hz = 0.45", "frequency_Hz = 20"),
             Contains("traction.toml:2:") && Contains("frequency_Hz = 20") && Contains("2"));
  CHECK_THAT(refusal("frequency_Hz", "frequncy_Hz"),
             Contains("frequncy_Hz") && Contains("frequency_Hz"));
  CHECK_THAT(refusal("cycles = 2", "cycles = 0"),
             Contains("traction.toml:7:") && Contains("cycles = 0") && Contains("1"));
  CHECK_THAT(refusal("cycles = 2", "cycles = 1.5"), Contains("cycles = 1.5"));
  CHECK_THAT(refusal("\"firmware\"", "\"hand\""), Contains("traction.toml:1:") &&
                                                      Contains("drive = \"hand\"") &&
                                                      Contains("prescribed"));
}
