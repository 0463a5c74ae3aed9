#include "tools/design_of_experiments/design.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "tools/design_of_experiments/factor.h"
#include "tools/run/errors.h"

using namespace hoof::tools;

namespace {

/// 1, x_i, x_i x_j, x_i^2.
Eigen::VectorXd quadratic(const std::vector<double>& x) {
  std::vector<double> terms = {1};
  for (const double v : x) terms.push_back(v);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = i; j < x.size(); ++j) terms.push_back(x[i] * x[j]);
  }
  return Eigen::Map<Eigen::VectorXd>(terms.data(), static_cast<Eigen::Index>(terms.size()));
}

Eigen::MatrixXd information(const Design& design) {
  Eigen::MatrixXd sum;
  for (const auto& run : design) {
    const Eigen::VectorXd t = quadratic(run);
    if (sum.size() == 0) sum = Eigen::MatrixXd::Zero(t.size(), t.size());
    sum += t * t.transpose();
  }
  return sum;
}

}  // namespace

TEST_CASE("designs have the runs of the books, each once, and tell a quadratic") {
  // Box and Behnken 1960: 12, 24 and 40 runs and centres; the paper's table has 12 + 5.
  for (const auto& [factors, runs] : {std::pair{3, 12}, {4, 24}, {5, 40}}) {
    const Design design = box_behnken(factors, 5);
    CHECK(design.size() == static_cast<std::size_t>(runs) + 5);
    CHECK(std::set<std::vector<double>>(design.begin(), design.end()).size() ==
          static_cast<std::size_t>(runs) + 1);
    for (const auto& run : design) {
      for (const double x : run) CHECK((x == 0 || std::abs(x) == 1));
    }
    CHECK(information(design).ldlt().isPositive());
    CHECK(Eigen::FullPivLU<Eigen::MatrixXd>(information(design)).isInvertible());
  }
  for (int factors = 2; factors <= 6; ++factors) {
    const Design design = central_composite(factors, 3, 1);
    CHECK(design.size() == (1u << factors) + 2u * static_cast<unsigned>(factors) + 3u);
    CHECK(Eigen::FullPivLU<Eigen::MatrixXd>(information(design)).isInvertible());
  }
}

TEST_CASE("a rotatable design foretells equally well in all directions, another does not") {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int factors = 2; factors <= 5; ++factors) {
    CAPTURE(factors);
    const auto spread = [&](double axis) {
      const Eigen::MatrixXd inverse = information(central_composite(factors, 4, axis)).inverse();
      double low = 1e300, high = 0;
      for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> x;
        double length = 0;
        for (int f = 0; f < factors; ++f)
          x.push_back(normal(random)), length += x.back() * x.back();
        for (double& v : x) v /= std::sqrt(length);
        const Eigen::VectorXd t = quadratic(x);
        const double variance = t.dot(inverse * t);
        low = std::min(low, variance), high = std::max(high, variance);
      }
      return high / low - 1;
    };
    CHECK(spread(rotatable_axis(factors)) < 1e-9);
    CHECK(spread(1.05 * rotatable_axis(factors)) > 1e-3);
  }
}

TEST_CASE("an order of runs holds each once, and is the seed's") {
  const auto order = run_order(17, 4);
  CHECK(std::set<int>(order.begin(), order.end()).size() == 17);
  CHECK(*std::min_element(order.begin(), order.end()) == 0);
  CHECK(order == run_order(17, 4));
  CHECK(order != run_order(17, 5));
}

TEST_CASE("a factor says what is wrong with it") {
  const Factor f = parse_factor("mu_s=0.2:0.9");
  CHECK(f.name == "mu_s");
  CHECK(f.coded(0.2) == Approx(-1));
  CHECK(f.value(1) == Approx(0.9));
  for (const char* text : {"mu_s", "=1:2", "a=1", "a=x:2", "a=1:2m", "a=2:1", "a=1:1", "a=1:inf"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_factor(text), UserError);
  }
}
