#include "tools/study/drop_law.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>
#include <sstream>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;

namespace {

/// Fall, impact on a plate at 45 degrees and flight, step by step, g = 9.81.
double flown_m(double e, double kept, double height_m, double height_after_m) {
  const double speed_m_s = std::sqrt(2 * 9.81 * height_m);
  // Normal of the plate (1, 1)/sqrt 2, downhill (1, -1)/sqrt 2, in x and z.
  const double r = std::numbers::sqrt2 / 2;
  const double normal_m_s = e * speed_m_s * r, tangential_m_s = kept * speed_m_s * r;
  const double vx_m_s = r * (normal_m_s + tangential_m_s);
  double vz_m_s = r * (normal_m_s - tangential_m_s);
  const double dt_s = 1e-6;
  double x_m = 0, z_m = height_after_m;
  while (z_m > 0) {
    z_m += vz_m_s * dt_s - 9.81 * dt_s * dt_s / 2;
    vz_m_s -= 9.81 * dt_s;
    x_m += vx_m_s * dt_s;
  }
  return x_m;
}

}  // namespace

TEST_CASE("travel in closed form is that of the flight, rising and falling after the impact") {
  std::mt19937_64 random(5);
  const auto between = [&](double low, double high) {
    return low + (high - low) * double(random() % 1000) / 999;
  };
  for (int i = 0; i < 20; ++i) {
    const double e = between(0.1, 0.9), kept = between(0, 1);
    const double height_m = between(0.01, 0.1), after_m = between(0.01, 0.1);
    INFO("e " << e << ", k_t " << kept << ", H " << height_m << ", H2 " << after_m);
    CHECK(drop_travel(e, kept, height_m, after_m) ==
          Approx(flown_m(e, kept, height_m, after_m)).epsilon(1e-4));
  }
}

TEST_CASE("k_t = e leaves the plate level: L = 2 e H; a second height then only scales it") {
  for (const double e : {0.2, 0.5, 0.9}) {
    CHECK(drop_travel(e, e, 40, 40) == Approx(2 * e * 40));
    CHECK(drop_travel(e, e, 40, 10) == Approx(e * 40));
  }
}

TEST_CASE("the paper's table: numbers of an independent fit") {
  const auto& laws = drop_laws();
  const DropFit before = fit_drop_law(laws[kPaperLaw], paper_drop_table());
  CHECK(before.rms_mm == Approx(3.76).margin(0.005));
  const DropFit after = fit_drop_law(laws[kRetainedLaw], paper_drop_table());
  CHECK(after.values[1] == Approx(1.013).margin(0.001));
  // One standard deviation is 0.035; Student's t of 10 and more degrees is taken as 2.228.
  CHECK(after.interval[1] == Approx(2.228 * 0.035).margin(0.002));
  const DropFit frictionless = fit_drop_law(laws[3], paper_drop_table());
  CHECK(frictionless.values[0] == Approx(40.42).margin(0.01));
  CHECK(frictionless.interval[0] == Approx(2.228 * 0.06).margin(0.03));
  CHECK(frictionless.rms_mm == Approx(0.251).margin(0.001));
  CHECK(fit_drop_law(laws[kFreeCurve], paper_drop_table()).rms_mm == Approx(0.244).margin(0.001));
  // Sticking with a second height does as well: the table does not tell the two apart.
  const DropFit sticking = fit_drop_law(laws[5], paper_drop_table());
  CHECK(sticking.rms_mm == Approx(0.246).margin(0.003));
  CHECK(fit_drop_law(laws[4], paper_drop_table()).rms_mm > 0.6);
  CHECK(before.held_out_rms_mm > 10 * after.held_out_rms_mm);
  CHECK(fit_drop_law(laws[kRetainedTwoHeightsLaw], paper_drop_table()).interval[1] >
        5 * after.interval[1]);
}

TEST_CASE("a table made with friction is found to have it, and its error held out is its noise") {
  std::mt19937_64 random(77);  // noise seed
  std::normal_distribution<double> normal;
  std::vector<DropRow> rows;
  for (int i = 0; i < 30; ++i) {
    const double e = 0.2 + 0.02 * i;
    rows.push_back({e, drop_travel(e, 0.72, 55, 55) + 0.2 * normal(random)});
  }
  const DropFit fit = fit_drop_law(drop_laws()[kRetainedLaw], rows);
  CHECK(std::abs(fit.values[1] - 0.72) < 1.5 * fit.interval[1]);
  CHECK(fit.interval[1] < 0.05);
  CHECK(fit.held_out_rms_mm == Approx(0.2).margin(0.08));
  CHECK(fit.held_out_rms_mm > fit.rms_mm);
}

TEST_CASE("fewer rows than numbers cannot be fitted") {
  CHECK_THROWS_AS(fit_drop_law(drop_laws()[kFreeCurve], {{0.3, 30}, {0.4, 40}}),
                  std::invalid_argument);
}

TEST_CASE("the study prints before and after and writes both tables") {
  const hoof::tests::ScratchFolder scratch;
  const auto out = scratch.path() / "deep" / "drop";
  std::ostringstream text;
  std::streambuf* const console = std::cout.rdbuf(text.rdbuf());
  run_drop_law_study(out.string());
  std::cout.rdbuf(console);
  CHECK_THAT(text.str(), Catch::Contains("| 2 e H (k_t = e) "));
  CHECK_THAT(read_file(out / "laws.csv"), Catch::Contains("\nk_t free,2,40.3"));
  CHECK_THAT(read_file(out / "rows.csv"), Catch::Contains("\n0.35,39.88,-7.3"));
  CHECK_THROWS_AS(run_drop_law_study((out / "laws.csv" / "x").string()), UserError);
}
