// The baselines on made-up regressions whose answer is known.

#include "tools/conceal/regression.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tools/conceal/random_stream.h"

using namespace hoof::tools::conceal;

namespace {

/// y = 2 a + shares of two features and of sin(3 a) + noise.
RegressionProblem problem_of(double first, double second, double curve, double noise) {
  RandomStream random(9);
  const Eigen::Index n = 600;
  RegressionProblem p;
  p.measured.resize(n);
  p.nominal.resize(n, 2);
  p.state.resize(n, 2);
  Eigen::MatrixXd a(n, 1), b(n, 1), c(n, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    a(i, 0) = random.normal(), b(i, 0) = random.normal(), c(i, 0) = random.normal();
    p.nominal.row(i) << x, 1.0;
    p.state.row(i) << x, random.normal();
    p.measured[i] = 2.0 * x + first * a(i, 0) + second * b(i, 0) + curve * std::sin(3.0 * x) +
                    noise * random.normal();
  }
  p.dictionary = {{"first", a}, {"second", b}, {"third", c}};
  return p;
}

}  // namespace

TEST_CASE("sparse regression finds none, one, both, the larger first") {
  CHECK(pick_by_sparse_regression(problem_of(0.0, 0.0, 0.0, 0.1)) == "none");
  CHECK(pick_by_sparse_regression(problem_of(0.0, 0.1, 0.0, 0.1)) == "second");
  CHECK(pick_by_sparse_regression(problem_of(0.1, 0.3, 0.0, 0.1)) == "second+first");
}

TEST_CASE("a Gaussian process sees a curve in the state and nothing in noise") {
  CHECK(pick_by_gaussian_process(problem_of(0.0, 0.0, 0.0, 0.1)) == "none");
  CHECK(pick_by_gaussian_process(problem_of(0.0, 0.0, 0.5, 0.1)) == "unknown");
}

TEST_CASE("what is left is at right angles to what was fitted") {
  const RegressionProblem p = problem_of(0.0, 0.0, 0.5, 0.1);
  const Eigen::VectorXd left = left_over(p.nominal, p.measured);
  CHECK((p.nominal.transpose() * left).norm() < 1e-9 * p.measured.norm());
}
