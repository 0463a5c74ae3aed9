#include "tools/study/press.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "sim/dem/sand_bed.h"
#include "tests/tools/run/scratch_folder.h"
#include "tests/tools/study/one_grain.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using namespace hoof::tests;

TEST_CASE("the force of one grain between floor and strip is Hertz's") {
  const PressCase c = one_grain_case();
  const PressCurve curve = press(c, materials(), one_grain(), 1, {});
  REQUIRE(curve.blow_up.empty());
  CHECK(curve.grain_count == 1);
  REQUIRE(curve.samples.size() == 3);  // one of 0.1 mm above the sand, two below

  const auto m = materials();
  const auto compliance = [](const hoof::sim::Material& a) {
    return (1 - a.poisson.value * a.poisson.value) / a.young_Pa.value;
  };
  const double e_star_Pa = 1 / (compliance(m.sand) + compliance(m.abs));
  // F = 4/3 E* sqrt(R) delta^1.5; floor and strip share the way evenly, and the mean of way^1.5
  // from a to b is (b^2.5 - a^2.5) / (2.5 (b - a)).
  const auto mean_N = [&](double a_m, double b_m) {
    return 4.0 / 3 * e_star_Pa * std::sqrt(kGrainRadius_m) * std::pow(0.5, 1.5) *
           (std::pow(b_m, 2.5) - std::pow(a_m, 2.5)) / (2.5 * (b_m - a_m));
  };
  CHECK(curve.samples[0].depth_m == Approx(-0.05e-3).epsilon(1e-3));
  CHECK(curve.samples[0].force_N == 0);
  CHECK(curve.samples[1].depth_m == Approx(0.05e-3).epsilon(1e-3));
  // 1 %: inertia and damping of the grain, both of the order of its period over the time taken.
  CHECK(curve.samples[1].force_N == Approx(mean_N(0, 1e-4)).epsilon(0.01));
  CHECK(curve.samples[2].force_N == Approx(mean_N(1e-4, 2e-4)).epsilon(0.01));
  // Half of 0.2 mm in a grain of 2 mm.
  CHECK(curve.samples[2].overlap_ratio == Approx(0.05).epsilon(0.02));
}

TEST_CASE("a force is a mean over depths, and none where the run did not get that deep") {
  PressCurve curve;
  for (int i = 0; i < 20; ++i) {
    curve.samples.push_back({(i + 0.5) * 1e-4, 100.0 * i, 0, 0, 0, 0});
  }
  CHECK(curve.force_at_N(1e-3, 0.26e-3) == Approx(950));  // of samples 7 to 12
  CHECK(curve.force_at_N(1e-3, 0.06e-3) == Approx(950));  // of samples 9 and 10
  CHECK(std::isnan(curve.force_at_N(2.2e-3, 0.5e-3)));
  CHECK(std::isnan(PressCurve{}.force_at_N(1e-3)));
}

TEST_CASE("a blow-up is a result: its words are kept and its force is no number") {
  PressCase c = one_grain_case();
  c.dt_s = 2e-4;  // twice the grain's own period
  c.depth_m = 2e-3;
  const PressCurve curve = press(c, materials(), one_grain(), 1, {});
  CHECK_THAT(curve.blow_up, Catch::Contains("blow-up at step"));
  CHECK(std::isnan(curve.samples.back().force_N));
  const ScratchFolder scratch;
  write_curve(scratch.path() / "c.csv", curve);
  const PressCurve read = read_curve(scratch.path() / "c.csv");
  CHECK_THAT(read.blow_up, Catch::Contains("blow-up at step"));
  CHECK(std::isnan(read.samples.back().force_N));
}

TEST_CASE("a curve is read back as it was written, and a damaged one names its file") {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "c.csv";
  PressCurve curve;
  curve.grain_count = 7;
  curve.solid_share = 0.6;
  curve.samples = {{-1e-4, 0, 0.1, 0.2, 3, 0.4}, {1.0 / 3, 2.0 / 3, 5, 6, 7, 8}};
  write_curve(file, curve);
  const PressCurve read = read_curve(file);
  CHECK(read.grain_count == 7);
  CHECK(read.solid_share == 0.6);
  REQUIRE(read.samples.size() == 2);
  CHECK(read.samples[0].depth_m == -1e-4);
  CHECK(read.samples[1].force_N == 2.0 / 3);
  CHECK(read.samples[1].rebuild_count == 7);
  CHECK(read.blow_up.empty());

  write_file(file, "depth_m,force_N\n1,2\n");
  CHECK_THROWS_WITH(read_curve(file), Catch::Contains("c.csv:1: no column"));
  write_file(file, read_file(file).substr(0, 20));
  CHECK_THROWS_AS(read_curve(file), UserError);
}

TEST_CASE("the key tells apart whatever changes a result") {
  const PressCase base = one_grain_case();
  const auto key = [](const PressCase& c) { return c.key(materials()); };
  const auto differs = [&](auto change) {
    PressCase c = base;
    change(c);
    return key(c) != key(base);
  };
  CHECK(key(base) == key(one_grain_case()));
  CHECK(differs([](PressCase& c) { c.seed = 2; }));
  CHECK(differs([](PressCase& c) { c.speed_m_s = 0.1; }));
  CHECK(differs([](PressCase& c) { c.depth_m = 1e-3; }));
  CHECK(differs([](PressCase& c) { c.dt_s = 1e-6; }));
  CHECK(differs([](PressCase& c) { c.cell_m = 4e-3; }));
  CHECK(differs([](PressCase& c) { c.smooth = true; }));
  CHECK(differs([](PressCase& c) { c.offset_x_m = 1e-3; }));
  CHECK(differs([](PressCase& c) { c.bed.depth_m = 0.05; }));
  CHECK(differs([](PressCase& c) { c.indenter.parts[0].yaw_rad = 0; }));
  CHECK(differs([](PressCase& c) { c.indenter.parts[0].mesh.vertices_m[3].x() += 1e-3; }));
}

TEST_CASE("a press stops when it is told to") {
  int calls = 0;
  CHECK_THROWS_WITH(press(one_grain_case(), materials(), one_grain(), 1,
                          [&calls](double) { return ++calls < 2; }),
                    "stopped");
  CHECK(calls == 2);
}
