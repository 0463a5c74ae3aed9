#include "tools/diagnose/separation.h"

#include <Eigen/Dense>

namespace hoof::tools {
namespace {

constexpr int kSteps = 3;
constexpr int kHalvings = 2;

/// Directions of both, those of b with the sign in which they enter y_a - y_b.
Eigen::MatrixXd directions(const WhitePrediction& a, const WhitePrediction& b) {
  Eigen::MatrixXd N(a.y.size(), a.M.cols() + b.M.cols());
  N << a.M, -b.M;
  return N;
}

}  // namespace

double separation_squares(const WhitePrediction& a, const WhitePrediction& b) {
  const Eigen::VectorXd d = a.y - b.y;
  const Eigen::MatrixXd N = directions(a, b);
  const Eigen::Index k = N.cols();
  // S^-1 = I - N (I + N'N)^-1 N' (Woodbury).
  const Eigen::MatrixXd K = Eigen::MatrixXd::Identity(k, k) + N.transpose() * N;
  const Eigen::VectorXd Nd = N.transpose() * d;
  return std::max(d.squaredNorm() - Nd.dot(K.llt().solve(Nd)), 0.0);
}

double width_squares(const WhitePrediction& a, const WhitePrediction& b) {
  struct Side {
    Eigen::MatrixXd G, K_inverse;
    double log_det = 0;
    explicit Side(const Eigen::MatrixXd& M) : G(M.transpose() * M) {
      const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(G.rows(), G.cols());
      const Eigen::LLT<Eigen::MatrixXd> llt(I + G);
      K_inverse = llt.solve(I);
      log_det = 2 * llt.matrixLLT().diagonal().array().log().sum();
    }
  };
  const Side of_a(a.M), of_b(b.M);
  const Eigen::MatrixXd C = a.M.transpose() * b.M;
  // tr(S_a^-1 S_b) - n with S_a^-1 = I - M_a K_a^-1 M_a'.
  const double a_rival = of_b.G.trace() - (of_a.K_inverse * of_a.G).trace() -
                         (of_a.K_inverse * C * C.transpose()).trace() + of_a.log_det - of_b.log_det;
  const double b_rival = of_a.G.trace() - (of_b.K_inverse * of_b.G).trace() -
                         (of_b.K_inverse * C.transpose() * C).trace() + of_b.log_det - of_a.log_det;
  return std::max(std::min(a_rival, b_rival), 0.0);
}

double closest_approach(const WhitePrediction& a, const WhitePrediction& b,
                        const MovedPrediction& move_a, const MovedPrediction& move_b) {
  const Eigen::MatrixXd N = directions(a, b);
  const Eigen::Index k = N.cols();
  const Eigen::LLT<Eigen::MatrixXd> K(Eigen::MatrixXd::Identity(k, k) + N.transpose() * N);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(k), d = a.y - b.y;
  double best = d.squaredNorm();
  for (int i = 0; i < kSteps; ++i) {
    Eigen::VectorXd step = -K.solve(N.transpose() * d + u);
    bool nearer = false;
    for (int halving = 0; halving <= kHalvings && !nearer; ++halving, step *= 0.4) {
      const Eigen::VectorXd to = u + step;
      const Eigen::VectorXd moved = move_a(to.head(a.M.cols())) - move_b(to.tail(b.M.cols()));
      const double squares = moved.squaredNorm() + to.squaredNorm();
      if (!(squares < best)) continue;
      nearer = squares < 0.99 * best;
      u = to, d = moved, best = squares;
      break;
    }
    if (!nearer) break;
  }
  return best;
}

Eigen::MatrixXd tempered_root(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& prior_sigma,
                              double temper) {
  const Eigen::Index k = prior_sigma.size();
  const Eigen::MatrixXd prior = prior_sigma.array().square().inverse().matrix().asDiagonal();
  Eigen::MatrixXd precision = prior;
  const Eigen::Index known = covariance.rows();
  if (known > 0 && covariance.allFinite()) {
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(covariance);
    const Eigen::MatrixXd P = ldlt.solve(Eigen::MatrixXd::Identity(known, known));
    if (ldlt.isPositive() && P.allFinite()) {
      const Eigen::MatrixXd data = P - prior.topLeftCorner(known, known);
      precision.topLeftCorner(known, known) += data / temper;
    }
  }
  precision = 0.5 * (precision + precision.transpose().eval());
  // C = V D^-1 V'; what rounding makes less certain than the prior is as certain as that.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(precision);
  const double least = prior.diagonal().minCoeff() * 1e-3;
  const Eigen::VectorXd D = k > 0 ? eigen.eigenvalues().array().max(least).matrix() : prior_sigma;
  return eigen.eigenvectors() * D.array().rsqrt().matrix().asDiagonal();
}

}  // namespace hoof::tools
