#include "tools/conceal/regression.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace hoof::tools::conceal {
namespace {

/// Smoothing makes neighbours alike: so many samples count as one.
constexpr double kAlike = 2.0;
constexpr double kBicGain = 10.0, kEvidence = 5.0;
constexpr Eigen::Index kProcessPoints = 250;

double bic(const Eigen::MatrixXd& columns, const Eigen::VectorXd& measured) {
  const double count = double(measured.size()) / kAlike;
  const double mean_square = left_over(columns, measured).squaredNorm() / double(measured.size());
  return count * std::log(mean_square) + double(columns.cols()) * std::log(count);
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd out(a.rows(), a.cols() + b.cols());
  out << a, b;
  return out;
}

/// Log evidence of zero-mean values under a squared-exponential kernel plus noise.
double log_evidence(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, double length,
                    double signal2, double noise2) {
  Eigen::MatrixXd k(x.rows(), x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double far2 = (x.row(i) - x.row(j)).squaredNorm() / (length * length);
      k(i, j) = k(j, i) = signal2 * std::exp(-0.5 * far2);
    }
    k(i, i) += noise2;
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(k);
  double log_determinant = 0.0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    log_determinant += std::log(factor.matrixLLT()(i, i));
  }
  return -0.5 * y.dot(factor.solve(y)) - log_determinant;
}

}  // namespace

Eigen::VectorXd left_over(const Eigen::MatrixXd& columns, const Eigen::VectorXd& measured) {
  const Eigen::VectorXd size = columns.colwise().norm().cwiseMax(1e-300).transpose();
  const Eigen::MatrixXd scaled = columns * size.cwiseInverse().asDiagonal();
  return measured - scaled * scaled.colPivHouseholderQr().solve(measured);
}

std::string pick_by_sparse_regression(const RegressionProblem& problem) {
  Eigen::MatrixXd columns = problem.nominal;
  std::string name;
  for (int count = 0; count < 2; ++count) {
    double least = bic(columns, problem.measured) - kBicGain;
    const RegressionProblem::Feature* best = nullptr;
    for (const auto& feature : problem.dictionary) {
      if (feature.effect == name) continue;
      const double there = bic(beside(columns, feature.columns), problem.measured);
      if (there < least) least = there, best = &feature;
    }
    if (best == nullptr) break;
    columns = beside(columns, best->columns);
    name += (name.empty() ? "" : "+") + best->effect;
  }
  return name.empty() ? "none" : name;
}

std::string pick_by_gaussian_process(const RegressionProblem& problem) {
  const Eigen::VectorXd left = left_over(problem.nominal, problem.measured);
  const Eigen::Index step = std::max<Eigen::Index>(1, left.size() / kProcessPoints);
  const Eigen::Index count = (left.size() + step - 1) / step;
  Eigen::VectorXd y(count);
  Eigen::MatrixXd x(count, problem.state.cols());
  const Eigen::RowVectorXd mean = problem.state.colwise().mean();
  const Eigen::RowVectorXd spread =
      ((problem.state.rowwise() - mean).colwise().squaredNorm() / double(left.size())).cwiseSqrt();
  for (Eigen::Index i = 0; i < count; ++i) {
    y[i] = left[i * step];
    x.row(i) = (problem.state.row(i * step) - mean).cwiseQuotient(spread);
  }
  const double power = y.squaredNorm() / double(count);
  const double noise_only = log_evidence(x, y, 1.0, 0.0, power);
  double best = -std::numeric_limits<double>::infinity();
  for (const double length : {0.2, 0.5, 1.0, 2.0}) {
    for (const double share : {0.05, 0.2, 0.5, 0.8}) {
      best = std::max(best, log_evidence(x, y, length, share * power, (1.0 - share) * power));
    }
  }
  return best > noise_only + kEvidence ? "unknown" : "none";
}

}  // namespace hoof::tools::conceal
