// Presses on fast soil against closed forms; what the check against grains reads from numbers; its
// smallest case as a user starts it.
#include "tools/study/grains_check.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <sstream>

#include "sim/terrain/rft_law.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/experiment/run_settings.h"
#include "tools/report/sample_table.h"
#include "tools/run/errors.h"
#include "tools/study/fast_press.h"

using namespace hoof;
using namespace hoof::tools;
using hoof::tests::ScratchFolder;

namespace {

/// 40 x 60 mm, one side, facing down.
PressCase plate_case() {
  PressCase c;
  sim::TriangleMesh mesh;
  mesh.vertices_m = {{-0.02, -0.03, 0}, {0.02, -0.03, 0}, {0.02, 0.03, 0}, {-0.02, 0.03, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  c.indenter = {"plate", {{mesh, Eigen::Vector3d::Zero(), 0}}};
  return c;
}

const sim::RftTerrainSettings& soil() {
  static const sim::RftTerrainSettings demo = read_run_settings("sinkage", {}).rft;
  return demo;
}

double force_N(double depth_m, const SoilEffectChoice& effect) {
  return press_fast_soil(plate_case(), soil(), effect).force_at_N(depth_m);
}

}  // namespace

TEST_CASE("a flat plate on fast soil meets the law's force, and what an effect makes of it") {
  const double depth_m = 0.01;
  REQUIRE(soil().pressure_law == sim::PressureLaw::kLinear);
  const double nominal_N =
      40e-3 * 60e-3 * sim::rft::flat_plate_alpha() * soil().xi_n_N_m3.value * depth_m;
  CHECK(force_N(depth_m, {}) == Approx(nominal_N).epsilon(0.01));
  CHECK(force_N(depth_m, {"hard_layer", {0.004, 3}}) == Approx(nominal_N * 2.2).epsilon(0.01));
  CHECK(force_N(depth_m, {"hard_layer", {0.012, 3}}) == force_N(depth_m, {}));
  // A wall that is not told of is 0.1 m away.
  CHECK(force_N(depth_m, {"wall_confinement", {30}}) == Approx(nominal_N * 1.3).epsilon(0.01));
  CHECK_THROWS_AS(force_N(depth_m, {"backlash", {0.1}}), std::invalid_argument);
}

TEST_CASE("a strength is found where the change meets its target, up or down, or at an end") {
  const auto up = [](double x) { return x * x; };
  const auto down = [](double x) { return 1 / x; };
  CHECK(solve_monotone(up, 4, 0.1, 100) == Approx(2));
  CHECK(solve_monotone(down, 4, 0.1, 100) == Approx(0.25));
  CHECK(solve_monotone(up, 1e6, 0.1, 100) == Approx(100));
  CHECK(solve_monotone(up, -1, 0.1, 100) == Approx(0.1));
}

TEST_CASE("grains tell a sign only beyond the interval of their beds") {
  const auto change = [](double grains, double fast, bool fitted = false) {
    return GrainsChange{sample_of({grains - 0.01, grains, grains + 0.01}), fast, fitted};
  };
  CHECK(change(0.3, 0.1).sign_agrees() == "yes");
  CHECK(change(-0.3, -0.6).sign_agrees() == "yes");
  CHECK(change(-0.3, -0.6).size_ratio() == Approx(2));
  CHECK(change(0.3, -0.1).sign_agrees() == "no");
  CHECK(change(-0.3, 0.1).sign_agrees() == "no");
  CHECK(change(0.3, 0).sign_agrees() == "no effect on fast soil");
  CHECK(change(0.3, 0.3, true).sign_agrees() == "fitted here");
  CHECK(change(0.02, 0.3).sign_agrees() == "not told");  // half of 95 %: 0.025
  CHECK(std::isnan(change(0.02, 0.3).size_ratio()));
  GrainsChange one{sample_of({0.3}), 0.3, false};
  CHECK(one.sign_agrees() == "not told");
}

TEST_CASE("worn spines in coarse grains, as a user starts it; a case that there is not") {
  const ScratchFolder scratch;
  StudyOptions options;
  options.out = scratch.path() / "study";
  options.beds = scratch.path() / "beds";
  options.bed_count = 1;
  options.threads = 1;
  options.scales = {3.6};
  options.settings = {"experiment.speed_m_s=0.8"};
  options.bodies = {"worn-spines", "cohesive-sand"};
  options.quiet = true;
  std::ostringstream text;
  std::streambuf* const console = std::cout.rdbuf(text.rdbuf());
  CHECK_NOTHROW(run_grains_check(options));
  options.bodies = {"worn-toes"};
  CHECK_THROWS_AS(run_grains_check(options), UserError);
  std::cout.rdbuf(console);
  CHECK_THAT(text.str(), Catch::Contains("cohesive-sand (cohesion): not checked"));
  const SampleTable table = read_samples(options.out / "grains-check.csv");
  CHECK(table.find("depth_mm")->numbers == std::vector<double>{-2, 5, 8, 13});
  for (const double force_N : table.find("grains_without_N")->numbers) CHECK(force_N > 0);
  // Shorter spines bear less where there is nothing else, in grains and on fast soil.
  CHECK(table.find("grains_change_ratio")->numbers.front() < 0);
  for (const double change : table.find("fast_soil_change_ratio")->numbers) CHECK(change < 0);
  for (const std::string& told : table.find("sign_agrees_name")->texts) CHECK(told == "not told");
}
