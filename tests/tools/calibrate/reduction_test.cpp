// Tables, fits and closed forms, against numbers that were found elsewhere.
#include "tools/calibrate/reduction.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/tools/calibrate/lab_sand.h"
#include "tools/calibrate/lab_formulas.h"
#include "tools/study/drop_law.h"

using namespace hoof::tools;
using hoof::tests::kDegree;

TEST_CASE("binned mean: middles of bins, both signs; the bin's error is its width over sqrt 12") {
  CHECK(binned_mean({0.1, 3.9}, 4) == Approx(2));
  CHECK(binned_mean({-0.1}, 4) == Approx(-2));
  CHECK(binned_mean({4.0}, 4) == Approx(6));  // a lower edge belongs to its bin
  CHECK(binned_mean({50, 51, 53}, 4) == Approx((50 + 50 + 54) / 3.0));
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const double value = 40 + 0.004 * i;  // over one bin, evenly
    sum += std::pow(binned_mean({value}, 4) - value, 2) / 1000;
  }
  CHECK(std::sqrt(sum) == Approx(4 / std::sqrt(12.0)).epsilon(0.002));
  CHECK_THROWS_AS(binned_mean({}, 4), std::invalid_argument);
  CHECK_THROWS_AS(binned_mean({1}, 0), std::invalid_argument);
}

TEST_CASE("the tables give the paper's fits, with the minus signs put back") {
  std::vector<PaperRow> drops;
  for (const DropRow& row : paper_drop_table()) drops.push_back({row.e, row.travel_mm});
  // To the two digits that are printed.
  const auto agree = [](const Quadratic& printed, const std::vector<PaperRow>& rows) {
    const Quadratic fit = fit_quadratic(rows);
    for (std::size_t i = 0; i < 3; ++i) CHECK(fit[i] == Approx(printed[i]).margin(0.0055));
  };
  agree(kPaperDropFit_mm, drops);
  agree(kPaperTiltFit_deg, paper_tilt_table());
  agree(kPaperRollFit_mm, paper_roll_table());
  // The paper's own roots, and its check values but that of the drop, which misses its fit.
  CHECK(root_of(kPaperDropFit_mm, 50.92, 0.1, 1) == Approx(0.5637).margin(1e-4));
  CHECK(root_of(kPaperTiltFit_deg, 30.89, 0.3, 0.7) == Approx(0.5930).margin(1e-4));
  CHECK(root_of(kPaperRollFit_mm, 36.56, 0, 0.3) == Approx(0.0404).margin(1e-4));
  CHECK(paper_repose_fit_deg(0.54, 0.34, 0.52) == Approx(37.8).margin(0.03));
  CHECK(std::isnan(root_of(kPaperRollFit_mm, 90, 0, 0.3)));
  CHECK_THROWS_AS(fit_quadratic({{1, 1}, {2, 2}, {2, 3}}), std::invalid_argument);
}

TEST_CASE("table 2 of the tool is that of the test data") {
  std::ifstream file(std::string(HOOF_TEST_DATA_DIR) + "/paper/table2.csv");
  std::string line;
  while (std::getline(file, line) && line.front() == '#') {
  }
  REQUIRE(line == "e,mu_r,mu_s,repose_deg");
  for (const ReposeRow& row : paper_repose_table()) {
    REQUIRE(std::getline(file, line));
    double e = 0, mu_r = 0, mu_s = 0, angle = 0;
    REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &e, &mu_r, &mu_s, &angle) == 4);
    CHECK(e == row.restitution);
    CHECK(mu_r == row.rolling_friction);
    CHECK(mu_s == row.static_friction);
    CHECK(angle == row.angle_deg);
  }
  CHECK_FALSE(std::getline(file, line));
}

TEST_CASE("table 5 is true rolling at one run and fall, and the paper's balance at another") {
  // Of an independent fit at 45 degrees: 0.131 to 0.138 mm rms for either.
  const auto rms = [](double run_mm, double inertia) {
    return rms_to(paper_roll_table(), [&](double mu_r) {
      return 1e3 * roll_travel_m(45 * kDegree, 1e-3 * run_mm, 64.3e-3, mu_r, inertia);
    });
  };
  CHECK(rms(49.6, kSolidSphere) < 0.14);
  CHECK(rms(35.4, 0) < 0.14);
  CHECK(rms(49.6, 0) > 2);
}

TEST_CASE("rolling friction of a travel is the inverse of the travel; nothing else is found") {
  for (const double mu_r : {0.0, 0.0408, 0.5}) {
    for (const double inertia : {0.0, 0.4}) {
      const double travel_m = roll_travel_m(0.7, 0.05, 0.06, mu_r, inertia);
      CHECK(rolling_friction_of(travel_m, 0.7, 0.05, 0.06, inertia) == Approx(mu_r).margin(1e-12));
    }
  }
  CHECK(rolling_acceleration_m_s2(0.5, std::tan(0.5) + 0.01) == 0);
  CHECK(rolling_acceleration_m_s2(0.5, 0, 0) == Approx(9.81 * std::sin(0.5)));
  CHECK(flight_travel_m(2, 0, 0.5 * 9.81) == Approx(2));        // one second of fall
  CHECK(flight_travel_m(2, 9.81, 0) == Approx(4));              // up and down again
  CHECK(flight_travel_m(-2, -9.81, 1.5 * 9.81) == Approx(-2));  // thrown down and back
  CHECK_THROWS_AS(rolling_friction_of(1, 0.7, 0.05, 0.06), std::invalid_argument);
  CHECK_THROWS_AS(rolling_friction_of(-0.01, 0.7, 0.05, 0.06), std::invalid_argument);
}
