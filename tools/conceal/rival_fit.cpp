#include "tools/conceal/rival_fit.h"

#include <Eigen/Dense>
#include <cmath>

#include "tools/conceal/seen_change.h"

namespace hoof::tools::conceal {
namespace {

constexpr int kMostSteps = 12;
constexpr double kGoodEnough = 1.0;
/// The same for the rival and for what it must stand in for.
constexpr double kStep_s = 5e-4;

/// Doubts first, in their sigmas; then the rival's numbers, each in units of its first value.
struct Candidate {
  ServoPlan plan;
  HiddenEffect rival;

  void move(const Eigen::VectorXd& by, const HiddenEffect& unit) {
    Eigen::Index i = 0;
    for (const DoubtfulParameter& d : plan.doubts) {
      double& value = plan.machine.*d.field;
      value = std::max(value + by[i++] * d.sigma, 0.0);
    }
    for (std::size_t p = 0; p < rival.parameters.size(); ++p) {
      rival.parameters[p].value += by[i++] * std::abs(unit.parameters[p].value);
    }
  }

  Eigen::VectorXd run() const { return whitened(plan, run_plan(plan, {rival}, kStep_s)); }
};

}  // namespace

double rival_misfit(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                    const HiddenEffect& rival) {
  const Eigen::VectorXd seen = whitened(plan, run_plan(plan, hidden, kStep_s));
  const Eigen::Index doubts = Eigen::Index(plan.doubts.size());
  const Eigen::Index size = doubts + Eigen::Index(rival.parameters.size());
  Candidate best{plan, rival};
  Eigen::VectorXd at = Eigen::VectorXd::Zero(size), predicted = best.run();
  const auto cost_of = [&](const Eigen::VectorXd& y, const Eigen::VectorXd& x) {
    return (seen - y).squaredNorm() + x.head(doubts).squaredNorm();
  };
  double cost = cost_of(predicted, at), damping = 1e-3;
  for (int step = 0; step < kMostSteps && cost > kGoodEnough && damping < 1e6; ++step) {
    Eigen::MatrixXd slope(seen.size(), size);
    for (Eigen::Index i = 0; i < size; ++i) {
      Candidate other = best;
      other.move(Eigen::VectorXd::Unit(size, i) * 0.01, rival);
      slope.col(i) = (other.run() - predicted) / 0.01;
    }
    Eigen::VectorXd gradient = slope.transpose() * (seen - predicted);
    gradient.head(doubts) -= at.head(doubts);
    Eigen::MatrixXd normal = slope.transpose() * slope;
    normal.diagonal().head(doubts).array() += 1.0;
    for (; damping < 1e6; damping *= 10.0) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd by = damped.ldlt().solve(gradient);
      Candidate other = best;
      other.move(by, rival);
      const Eigen::VectorXd y = other.run();
      const double there = cost_of(y, at + by);
      if (!(there < cost)) continue;
      const bool settled = there > 0.999 * cost;
      best = other, predicted = y, cost = there, at += by, damping *= 0.1;
      if (settled) return cost;
      break;
    }
  }
  return cost;
}

}  // namespace hoof::tools::conceal
