// How far apart predictions are when hypotheses may move, and what of a recording tells it best.
#include "tools/diagnose/separation.h"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/diagnose/goal_path.h"
#include "tools/diagnose/telling_reading.h"

using namespace hoof::tools;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

MatrixXd random_matrix(std::mt19937_64& random, int rows, int columns) {
  std::normal_distribution<double> normal;
  MatrixXd m(rows, columns);
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) m(i, j) = normal(random);
  }
  return m;
}

WhitePrediction still(const VectorXd& y) {
  return {y, MatrixXd(y.size(), 0)};
}

}  // namespace

TEST_CASE("separation: nothing free to move leaves the plain distance, in either order") {
  const VectorXd a = VectorXd::LinSpaced(5, 0, 4), b = VectorXd::Constant(5, 1);
  CHECK(separation_squares(still(a), still(b)) == Approx(1 + 0 + 1 + 4 + 9));
  CHECK(separation_squares(still(b), still(a)) == Approx(15));
  CHECK(separation_squares(still(a), still(a)) == 0);
}

TEST_CASE("separation: a difference along a free direction shrinks by that direction's width") {
  // d along the unit vector e, which one of them may move by w sigma: d^2 / (1 + w^2).
  const VectorXd zero = VectorXd::Zero(9), e = VectorXd::Constant(9, 1.0 / 3);
  for (const double w : {0.0, 0.5, 3.0, 1e3}) {
    for (const double d : {7.0, -7.0}) {
      const WhitePrediction free{zero, w * e};
      CHECK(separation_squares(free, still(d * e)) == Approx(49 / (1 + w * w)).epsilon(1e-6));
      CHECK(separation_squares(still(d * e), free) == Approx(49 / (1 + w * w)).epsilon(1e-6));
      const WhitePrediction both{d * e, w * e};
      CHECK(separation_squares(free, both) == Approx(49 / (1 + 2 * w * w)).epsilon(1e-6));
    }
  }
}

TEST_CASE("separation: as with the whole covariance, and the closest approach of lines is that") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    const WhitePrediction a{random_matrix(random, 30, 1), random_matrix(random, 30, 4)};
    const WhitePrediction b{random_matrix(random, 30, 1), random_matrix(random, 30, 3)};
    const MatrixXd S = MatrixXd::Identity(30, 30) + a.M * a.M.transpose() + b.M * b.M.transpose();
    const VectorXd d = a.y - b.y;
    const double squares = separation_squares(a, b);
    CHECK(squares == Approx(d.dot(S.llt().solve(d))).epsilon(1e-9));
    CHECK(squares <= d.squaredNorm());
    const MatrixXd Sa = MatrixXd::Identity(30, 30) + a.M * a.M.transpose();
    const MatrixXd Sb = MatrixXd::Identity(30, 30) + b.M * b.M.transpose();
    const auto widths = [](const MatrixXd& P, const MatrixXd& Q) {
      const MatrixXd R = P.llt().solve(Q);
      return R.trace() - 30 - std::log(R.determinant());
    };
    const double added = width_squares(a, b);
    CHECK(added == Approx(std::min(widths(Sa, Sb), widths(Sb, Sa))).epsilon(1e-9));
    CHECK(added == Approx(width_squares(b, a)).epsilon(1e-12));
    CHECK(added > 0);
    CHECK(width_squares(a, {b.y, a.M}) == Approx(0).margin(1e-9));
    const auto line = [](const WhitePrediction& p) {
      return [&p](const VectorXd& u) { return VectorXd(p.y + p.M * u); };
    };
    CHECK(closest_approach(a, b, line(a), line(b)) == Approx(squares).epsilon(1e-9));
  }
}

TEST_CASE("separation: what bends comes no nearer than it can, and no further than at rest") {
  // y = 4 + 3 sin(u) against 0: the line says 4^2 / (1 + 9), the curve leaves (4 - 3)^2 and u^2.
  const WhitePrediction a{VectorXd::Constant(1, 4), MatrixXd::Constant(1, 1, 3)};
  const WhitePrediction b = still(VectorXd::Zero(1));
  const auto curve = [](const VectorXd& u) {
    return VectorXd::Constant(1, 4 + 3 * std::sin(u[0])).eval();
  };
  const auto rest = [](const VectorXd&) { return VectorXd::Zero(1).eval(); };
  const double nearest = closest_approach(a, b, curve, rest);
  double least = 1e9;
  for (double u = -3; u < 3; u += 1e-3) {
    least = std::min(least, std::pow(4 + 3 * std::sin(u), 2) + u * u);
  }
  CHECK(nearest >= least - 1e-3);
  CHECK(nearest < 1.05 * least);
  const auto away = [](const VectorXd& u) {
    return VectorXd::Constant(1, 4 + 100 * u[0] * u[0]).eval();
  };
  CHECK(closest_approach(a, b, away, rest) <= 16);
}

TEST_CASE("separation: a covariance is counted down towards the prior, and no further") {
  std::mt19937_64 random(3);
  const VectorXd prior = VectorXd::LinSpaced(4, 0.5, 2);
  const MatrixXd J = random_matrix(random, 50, 4);
  const MatrixXd P0 = prior.array().square().inverse().matrix().asDiagonal();
  const MatrixXd C = (J.transpose() * J + P0).inverse();
  const auto covariance = [&](double temper) {
    const MatrixXd L = tempered_root(C, prior, temper);
    return MatrixXd(L * L.transpose());
  };
  CHECK((covariance(1) - C).norm() < 1e-9 * C.norm());
  const MatrixXd four = (J.transpose() * J / 4 + P0).inverse();
  CHECK((covariance(4) - four).norm() < 1e-9 * four.norm());
  CHECK((covariance(1e12) - MatrixXd(P0.inverse())).norm() < 1e-6);
  // A fit that was not judged has none: the prior stands.
  const MatrixXd L = tempered_root(MatrixXd(), prior, 4);
  CHECK((L * L.transpose() - MatrixXd(P0.inverse())).norm() < 1e-9);
}

TEST_CASE("telling reading: a level is told by a mean, a drift by a change, a blip by a sample") {
  const int n = 400;
  VectorXd level = VectorXd::Zero(n), blip = VectorXd::Zero(n), drift = VectorXd::Zero(n);
  level.segment(200, 10).setConstant(-2);
  blip[77] = 30;
  for (int i = 0; i < n; ++i) drift[i] = 5.0 * i / n;
  const WhitePrediction zero = still(VectorXd::Zero(n));
  const Reading mean = most_telling(still(level), zero);
  CHECK_FALSE(mean.change);
  CHECK(mean.late.first == 200);
  CHECK(mean.late.last == 209);
  CHECK(mean.sigmas == Approx(2 * std::sqrt(10.0)));
  CHECK(read(mean, still(level)).first == Approx(-2));
  CHECK(read(mean, still(level)).second == Approx(1 / std::sqrt(10.0)));
  const Reading sample = most_telling(still(blip), zero);
  CHECK(sample.late.first == 77);
  CHECK(sample.late.last == 77);
  CHECK(sample.sigmas == Approx(30));
  // Where the level itself is uncertain only its change tells.
  const WhitePrediction loose{VectorXd::Zero(n), VectorXd::Constant(n, 100)};
  const Reading change = most_telling(still(drift), loose);
  CHECK(change.change);
  CHECK(change.late.first == 390);
  CHECK(change.early.first == 0);
  CHECK(read(change, still(drift)).first == Approx(5.0 * 390 / n));
  CHECK(read(change, loose).second == Approx(std::sqrt(0.2)));
}

TEST_CASE("goal path: pieces join, and none is faster than was asked for") {
  GoalPath path(0.2, 0.01);
  path.hold(0.5).ease(-0.8, 0.7).ramp(0.9, 0.3).ease(0.1, 0.7);
  path.sine(0.4, 0.25, 2).chirp(0.5, 0.3, 8, 10, 0.6).off(1).hold(0.2);
  const auto& goal = path.goal_rad();
  const auto time_s = path.time_s();
  const auto on = path.enable();
  REQUIRE(goal.size() == time_s.size());
  REQUIRE(goal.size() == on.size());
  double fastest = 0;
  for (std::size_t i = 1; i < goal.size(); ++i) {
    REQUIRE(time_s[i] > time_s[i - 1]);
    fastest = std::max(fastest, std::abs(goal[i] - goal[i - 1]) / (time_s[i] - time_s[i - 1]));
  }
  CHECK(fastest < 0.72);  // rounded to whole samples
  CHECK(fastest > 0.6);
  CHECK(*std::min_element(goal.begin(), goal.end()) == Approx(-0.8));
  CHECK(*std::max_element(goal.begin(), goal.end()) == Approx(0.9));
  CHECK(std::count(on.begin(), on.end(), 0) == 100);
  CHECK(path.last_rad() == Approx(0.1).margin(1e-9));
  CHECK(GoalPath(0, 0.01).hold(1).enable().empty());
}
