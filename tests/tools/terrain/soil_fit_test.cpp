#include "tools/terrain/soil_fit.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/terrain/synthetic_pushes.h"
#include "tools/run/errors.h"
#include "tools/terrain/push_table.h"

using namespace hoof::tools;
using hoof::sim::PressureLaw;
using hoof::sim::RftTerrainSettings;
using hoof::tests::planted;
using hoof::tests::synthetic_pushes;

namespace {

/// What the fit must find from scratch.
RftTerrainSettings ignorant(PressureLaw law) {
  RftTerrainSettings soil = planted(law);
  soil.xi_n_N_m3.value = 1e5;
  soil.bekker_k_phi_Pa = 1e4, soil.bekker_k_c_N_m = 0, soil.bekker_exponent = 1.5;
  return soil;
}

}  // namespace

TEST_CASE("the synthetic pushes themselves: leading faces resist, others do not") {
  for (const Push& push : synthetic_pushes(planted(PressureLaw::kLinear), 0, 1)) {
    CAPTURE(push.plate.name);
    double work = 0;
    for (const PushSample& s : push.samples) {
      if (s.phase == PushPhase::kPush) work += s.force_N.dot(push.plate.direction());
    }
    CHECK(work < 0);
  }
}

TEST_CASE("a planted linear scale is found again, without and with noise") {
  const RftTerrainSettings truth = planted(PressureLaw::kLinear);
  const SoilFit exact = fit_soil(synthetic_pushes(truth, 0, 1), ignorant(PressureLaw::kLinear));
  CHECK(exact.soil.xi_n_N_m3.value == Approx(7.5e5).epsilon(3e-3));  // u_y is found to 0.7 %
  CHECK(exact.fit_error < 5e-3);
  CHECK(exact.held_out_error < 5e-3);
  CHECK(exact.soil.yield_displacement_m.value == Approx(0.6e-3).epsilon(0.01));
  for (const unsigned seed : {1u, 2u, 3u}) {
    INFO("seed " << seed);
    const SoilFit noisy =
        fit_soil(synthetic_pushes(truth, 0.1, seed), ignorant(PressureLaw::kLinear));
    // 10 pushes of 120 numbers and more: 0.1 / sqrt(1200) is 0.3 %, four of them.
    CHECK(noisy.soil.xi_n_N_m3.value == Approx(7.5e5).epsilon(0.01));
    // Three components of 0.1 each over a measured rms that holds the noise as well.
    CHECK(noisy.fit_error == Approx(std::sqrt(0.03 / 1.03)).epsilon(0.1));
    CHECK(noisy.held_out_error == Approx(std::sqrt(0.03 / 1.03)).epsilon(0.15));
  }
}

TEST_CASE("planted moduli and exponent of Bekker are found again") {
  const RftTerrainSettings truth = planted(PressureLaw::kBekker);
  const SoilFit exact = fit_soil(synthetic_pushes(truth, 0, 1), ignorant(PressureLaw::kBekker));
  // The exponent is found to 0.0023 at best; 25 mm to its power makes that 1 % of the moduli.
  CHECK(exact.soil.bekker_exponent == Approx(0.8).margin(0.01));
  CHECK(exact.soil.bekker_k_phi_Pa == Approx(1.2e5).epsilon(0.04));
  CHECK(exact.soil.bekker_k_c_N_m == Approx(2.5e3).epsilon(0.04));
  CHECK(exact.fit_error < 0.01);
  const SoilFit noisy = fit_soil(synthetic_pushes(truth, 0.05, 7), ignorant(PressureLaw::kBekker));
  CHECK(noisy.soil.bekker_exponent == Approx(0.8).margin(0.03));
  // And the linear law cannot do it as well.
  CHECK(fit_soil(synthetic_pushes(truth, 0, 1), ignorant(PressureLaw::kLinear)).fit_error > 0.03);
}

TEST_CASE("held-out pushes do not touch the fit") {
  const RftTerrainSettings truth = planted(PressureLaw::kLinear);
  auto pushes = synthetic_pushes(truth, 0, 1);
  const double before = fit_soil(pushes, truth).soil.xi_n_N_m3.value;
  for (Push& push : pushes) {
    if (!push.plate.held_out) continue;
    for (PushSample& s : push.samples) s.force_N *= 3;
  }
  const SoilFit after = fit_soil(pushes, truth);
  CHECK(after.soil.xi_n_N_m3.value == before);
  CHECK(after.held_out_error == Approx(2.0 / 3).epsilon(0.01));
}

TEST_CASE("pushes that do not determine a soil are refused with the reason") {
  const RftTerrainSettings linear = planted(PressureLaw::kLinear);
  auto pushes = synthetic_pushes(linear, 0, 1);
  CHECK_THROWS_WITH(fit_soil({pushes[0]}, linear),
                    "there are 1 pushes to fit, must be at least 2 that are not held out");
  std::vector<Push> one_width = {pushes[1], pushes[3], pushes[4]};  // all 60 mm
  CHECK_THROWS_WITH(fit_soil(one_width, planted(PressureLaw::kBekker)),
                    Catch::Contains("all fitted plates are 60 mm wide"));
  auto silent = pushes;
  for (PushSample& s : silent[3].samples) s.force_N.setZero();
  CHECK_THROWS_WITH(fit_soil(silent, linear), Catch::Contains("'" + pushes[3].plate.name + "'"));
  auto wrong_sign = pushes;
  for (Push& push : wrong_sign) {
    for (PushSample& s : push.samples) s.force_N = -s.force_N;
  }
  CHECK_THROWS_WITH(fit_soil(wrong_sign, linear), Catch::Contains("must be above 0"));
}

TEST_CASE("the shipped soil is what the kept pushes give") {
  // tests/data/terrain/demo-pushes.csv: pushes.csv of the command at the top of the soil's file.
  const RftTerrainSettings shipped = load_soil("demo");
  const SoilFit again =
      fit_soil(read_pushes(HOOF_TEST_DATA_DIR "/terrain/demo-pushes.csv"), shipped);
  CHECK(again.soil.xi_n_N_m3.value == Approx(shipped.xi_n_N_m3.value).epsilon(1e-9));
  CHECK(again.soil.yield_displacement_m.value ==
        Approx(shipped.yield_displacement_m.value).epsilon(1e-9));
  CHECK(again.fit_error == Approx(shipped.fit_error).epsilon(1e-9));
  CHECK(again.held_out_error == Approx(shipped.held_out_error).epsilon(1e-9));
}
