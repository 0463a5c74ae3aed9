// The source paper's table 2, whose analysis is printed there and was made again with scipy; and
// surfaces whose truth is known.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "tools/design_of_experiments/anova_report.h"
#include "tools/design_of_experiments/design.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
namespace fs = std::filesystem;

namespace {

const fs::path kTable2 = fs::path(HOOF_TEST_DATA_DIR) / "paper" / "table2.csv";
const std::vector<Factor> kBounds = {{"e", 0.1, 0.8}, {"mu_r", 0.1, 0.4}, {"mu_s", 0.2, 0.9}};

ResponseSurface table2() {
  const Runs runs = read_runs(kTable2, {"e", "mu_r", "mu_s"}, "repose_deg");
  REQUIRE(runs.response.size() == 17);
  return {kBounds, runs, SurfaceModel::kQuadratic};
}

const VarianceRow& row(const ResponseSurface& s, const std::string& source) {
  const auto at = std::find_if(s.variance().begin(), s.variance().end(),
                               [&](const VarianceRow& r) { return r.source == source; });
  REQUIRE(at != s.variance().end());
  return *at;
}

/// Runs of a quadratic in two factors with bounds 1..3 and -2..2, with noise.
Runs made(double noise, std::uint64_t seed, int centres) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Runs runs{"made", {}, {}};
  const Factor a{"a", 1, 3}, b{"b", -2, 2};
  for (const auto& x : central_composite(2, centres, 1)) {
    const double u = a.value(x[0]), v = b.value(x[1]);
    runs.factors.push_back({u, v});
    runs.response.push_back(5 + 2 * u - 3 * v + 0.5 * u * v - u * u + 0.25 * v * v +
                            noise * normal(random));
  }
  return runs;
}

}  // namespace

TEST_CASE("anova: the paper's table 2, its signs recovered") {
  const ResponseSurface s = table2();
  // As printed, to its two digits; signs as only one choice of them fits.
  const std::vector<std::pair<std::string, double>> printed = {
      {"1", -28.24},       {"e", 28.86},      {"mu_r", 116.45},     {"mu_s", 59.96},
      {"e*mu_r", 11.86},   {"e*mu_s", -2.27}, {"mu_r*mu_s", 126.0}, {"e^2", -35.33},
      {"mu_r^2", -175.56}, {"mu_s^2", -50.08}};
  REQUIRE(s.terms().size() == printed.size());
  const Eigen::VectorXd natural = s.natural();
  for (std::size_t i = 0; i < printed.size(); ++i) {
    CHECK(s.terms()[i] == printed[i].first);
    CHECK(natural[static_cast<Eigen::Index>(i)] == Approx(printed[i].second).margin(0.005));
  }
  CHECK(s.r2() == Approx(0.9988).margin(5e-5));
  // numpy and scipy's of the same table.
  CHECK(s.adjusted_r2() == Approx(0.9973520463872143).epsilon(1e-9));
  CHECK(s.predicted_r2() == Approx(0.9855764013720449).epsilon(1e-9));
  CHECK(s.adequate_precision() == Approx(93.31108246030834).epsilon(1e-9));
  CHECK(row(s, "model").f == Approx(670.6002135864652).epsilon(1e-9));
  CHECK(row(s, "model").p == Approx(1.965085229360397e-09).epsilon(1e-6));
  CHECK(row(s, "e").sum_of_squares == Approx(1.445).epsilon(1e-9));
  CHECK(row(s, "e").p == Approx(0.16661243142206855).epsilon(1e-7));
  CHECK(row(s, "mu_r").f == Approx(3167.413315628595).epsilon(1e-9));
  CHECK(row(s, "mu_s").p == Approx(7.068425278712319e-10).epsilon(1e-5));
  CHECK(row(s, "e*mu_r").p == Approx(0.1539334510229841).epsilon(1e-7));
  CHECK(row(s, "e*mu_s").p == Approx(0.499124378200547).epsilon(1e-7));
  CHECK(row(s, "mu_r*mu_s").sum_of_squares == Approx(175.0329).epsilon(1e-9));
  CHECK(row(s, "mu_s^2").f == Approx(261.2925594047279).epsilon(1e-9));
  CHECK(row(s, "residual").freedom == 7);
  CHECK(row(s, "lack of fit").f == Approx(4.089895893210741).epsilon(1e-9));
  CHECK(row(s, "lack of fit").p == Approx(0.10357007032516237).epsilon(1e-7));
  CHECK(row(s, "pure error").sum_of_squares == Approx(1.0438).epsilon(1e-9));
  CHECK(row(s, "total").sum_of_squares == Approx(3664.7815058823535).epsilon(1e-12));
}

TEST_CASE("anova: what is not noisy is found exactly, in natural units") {
  const Runs runs = made(0, 1, 1);
  const ResponseSurface s({{"a", 1, 3}, {"b", -2, 2}}, runs, SurfaceModel::kQuadratic);
  const Eigen::VectorXd n = s.natural();
  const std::vector<double> truth = {5, 2, -3, 0.5, -1, 0.25};
  for (Eigen::Index i = 0; i < 6; ++i) CHECK(n[i] == Approx(truth[static_cast<std::size_t>(i)]));
  CHECK(s.r2() == Approx(1));
  // Other bounds are other units: the surface stays.
  const ResponseSurface other({{"a", -7, 11}, {"b", 0, 1}}, runs, SurfaceModel::kQuadratic);
  CHECK((other.natural() - n).norm() < 1e-9);
}

TEST_CASE(
    "anova: predicted R2 is that of leaving each run out; rows add up; bands hold the truth") {
  int held = 0, trials = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    const Runs runs = made(0.4, seed, 4);
    const std::vector<Factor> bounds = {{"a", 1, 3}, {"b", -2, 2}};
    const ResponseSurface s(bounds, runs, SurfaceModel::kQuadratic);
    CHECK(row(s, "model").sum_of_squares + row(s, "residual").sum_of_squares ==
          Approx(row(s, "total").sum_of_squares));
    CHECK(row(s, "lack of fit").sum_of_squares + row(s, "pure error").sum_of_squares ==
          Approx(row(s, "residual").sum_of_squares));
    if (seed <= 5) {
      double press = 0;
      for (std::size_t i = 0; i < runs.response.size(); ++i) {
        Runs rest = runs;
        rest.factors.erase(rest.factors.begin() + static_cast<long>(i));
        rest.response.erase(rest.response.begin() + static_cast<long>(i));
        const ResponseSurface without(bounds, rest, SurfaceModel::kQuadratic);
        std::vector<double> x;
        for (std::size_t f = 0; f < 2; ++f) x.push_back(bounds[f].coded(runs.factors[i][f]));
        press += std::pow(runs.response[i] - without.at(x), 2);
      }
      CHECK(s.predicted_r2() == Approx(1 - press / row(s, "total").sum_of_squares));
    }
    const std::vector<double> x = {0.3, -0.6};
    const double u = bounds[0].value(x[0]), v = bounds[1].value(x[1]);
    const double truth = 5 + 2 * u - 3 * v + 0.5 * u * v - u * u + 0.25 * v * v;
    held += std::abs(s.at(x) - truth) < s.mean_half95(x) ? 1 : 0;
    ++trials;
    CHECK(s.run_half95(x) > s.mean_half95(x));
  }
  // 190 of 200 in the mean, 3 deviations are 9.
  CHECK(std::abs(held - 0.95 * trials) < 10);
}

TEST_CASE("anova: the optimum is that of a fine grid, inside or at a bound") {
  const ResponseSurface s = table2();
  for (const bool largest : {true, false}) {
    const auto x = s.optimum(largest);
    double best = largest ? -1e300 : 1e300;
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; j <= 40; ++j) {
        for (int k = 0; k <= 40; ++k) {
          const double y = s.at({i / 20.0 - 1, j / 20.0 - 1, k / 20.0 - 1});
          best = largest ? std::max(best, y) : std::min(best, y);
        }
      }
    }
    CHECK((largest ? s.at(x) - best : best - s.at(x)) >= -1e-9);
    // Half a step of the grid from a vertex bends by no more than this.
    CHECK(std::abs(s.at(x) - best) < 0.01);
  }
}

TEST_CASE("valley: the angle of repose leaves a sheet of sands, which mu_s or mu_r cut best") {
  const ResponseSurface s = table2();
  const Valley v = find_valley(s, 37.8, 0.45, {0.035, 0.015, 0.035});
  // numpy's of a grid of 71 x 61 x 71; this grid is 61 along each.
  CHECK(v.share == Approx(0.018377).epsilon(0.05));
  CHECK(v.low[0] == Approx(0.1));
  CHECK(v.high[0] == Approx(0.8));
  CHECK(v.low[1] == Approx(0.25).margin(0.01));
  CHECK(v.low[2] == Approx(0.46).margin(0.02));
  for (const auto& point : v.points) CHECK(std::abs(s.at(point) - 37.8) <= 0.45);
  REQUIRE(v.left.size() == 3);
  // Restitution hardly moves the angle: knowing it leaves the ranges of the others as wide.
  CHECK(v.left[0].width[1] > 0.9);
  CHECK(v.left[1].width[2] < 0.6);
  CHECK(v.most_telling() >= 0);
  // Knowing a factor to half its range leaves more than knowing it well.
  const Valley rough = find_valley(s, 37.8, 0.45, {0.35, 0.15, 0.35});
  for (std::size_t f = 0; f < 3; ++f) CHECK(rough.left[f].share > v.left[f].share);
  CHECK(find_valley(s, 90, 0.5, {1, 1, 1}).points.empty());
  CHECK(find_valley(s, 90, 0.5, {1, 1, 1}).most_telling() == -1);
}

TEST_CASE("anova: bad data are named") {
  const fs::path folder = fs::temp_directory_path() / "hoof_test_anova";
  fs::create_directories(folder);
  const auto file = [&](const std::string& text) {
    write_file(folder / "d.csv", text);
    return folder / "d.csv";
  };
  const auto says = [](const AnovaOptions& options, const std::string& part) {
    try {
      run_anova(options);
      return std::string("no error");
    } catch (const UserError& e) {
      const std::string what = e.what();
      return what.find(part) == std::string::npos ? what : part;
    }
  };
  AnovaOptions o;
  o.factors = {"a", "b"};
  o.response = "y";
  o.data = file("a,b,y\n1,2,3\n2,2,4\n3,2,5\n1,3,1\n2,3,1\n3,3,9\n");
  CHECK(says(o, "leave the term b^2 open") == "leave the term b^2 open");
  o.data = file("a,b,y\n1,2,3\n2,2,4\n3,2,5\n");
  CHECK(says(o, "the factor b is the same in all runs") == "the factor b is the same in all runs");
  o.data = file("a,b,y\n1,2,3\n2,3,4\n3,2,5\n");
  CHECK(says(o, "3 runs cannot tell 6 terms") == "3 runs cannot tell 6 terms");
  o.data = file("a,y\n1,2\n");
  CHECK(says(o, "no column b; there are a, y") == "no column b; there are a, y");
  o.data = file("a,b,y\n1,x,2\n");
  CHECK(says(o, "d.csv:2") == "d.csv:2");
  // Through as many runs as terms a surface always goes.
  o.model = SurfaceModel::kLinear;
  o.data = file("a,b,y\n1,2,3\n2,3,4\n3,2,5\n");
  CHECK(run_anova(o).find("no variance is told") != std::string::npos);
  o.model = SurfaceModel::kQuadratic;
  o.response = "a";
  CHECK(says(o, "a is a factor and the response") == "a is a factor and the response");
  o = {};
  o.data = kTable2;
  o.factors = {"e", "mu_r", "mu_s"};
  o.response = "repose_deg";
  o.ranges = {"mu=0:1"};
  CHECK(says(o, "no factor mu") == "no factor mu");
  o.ranges.clear();
  o.has_target = true, o.target = 37.8, o.tolerance = 0.45;
  o.doubts = {"e:0.1"};
  CHECK(says(o, "write NAME=DOUBT") == "write NAME=DOUBT");
  o.doubts = {"e=-1"};
  CHECK(says(o, "write NAME=DOUBT") == "write NAME=DOUBT");
  o.doubts = {"e=0.02"};
  o.out = folder / "out";
  const std::string text = run_anova(o);
  CHECK(text.find("R2 0.9988") != std::string::npos);
  CHECK(text.find("tells most") != std::string::npos);
  std::ifstream json(o.out / "anova.json");
  CHECK(nlohmann::json::parse(json).at("variance").size() == 14);
  CHECK(fs::file_size(o.out / "valley.csv") > 1000);
  CHECK(fs::exists(o.out / "predicted.csv"));
  fs::remove_all(folder);
}
