// How far apart two hypotheses' predictions of an experiment are, when each may still move within
// what the recordings allow.
//
// Symbol  Meaning                                                                 Unit
// y       prediction, in sigmas of the noise                                      1
// M       change of y by one sigma of each free direction of the hypothesis       1
//         (Jacobian times a root of the covariance of its numbers)
// S       I + M_a M_a' + M_b M_b': covariance of y_a - y_b                        1
//
// The square of the separation is (y_a - y_b)' S^-1 (y_a - y_b), the criterion of Buzzi-Ferraris
// and Forzatti, Chem. Eng. Sci. 39 (1984) 81. Half of it, and of what the widths add, is the
// logarithm of the odds that an experiment is expected to give (Box, Hill: Technometrics 9 (1967)
// 57).
#pragma once

#include <Eigen/Core>
#include <functional>

namespace hoof::tools {

struct WhitePrediction {
  Eigen::VectorXd y;
  Eigen::MatrixXd M;
};

/// Square of the separation, linearised.
double separation_squares(const WhitePrediction& a, const WhitePrediction& b);

/// What different widths add to that: a hypothesis that would allow many outcomes and is wrong pays
/// for it. With S_a = I + M_a M_a' and S_b alike, tr(S_a^-1 S_b) - n - log det(S_a^-1 S_b), or with
/// a and b changed where that is less. Never negative.
double width_squares(const WhitePrediction& a, const WhitePrediction& b);

/// y of a hypothesis that is moved by u, in the directions of M.
using MovedPrediction = std::function<Eigen::VectorXd(const Eigen::VectorXd& u)>;

/// The least of |y_a(u_a) - y_b(u_b)|^2 + |u_a|^2 + |u_b|^2 that a few steps of Gauss-Newton with
/// the slopes of the start find: what the linearised square would be where predictions bend.
/// Never more than at u = 0.
double closest_approach(const WhitePrediction& a, const WhitePrediction& b,
                        const MovedPrediction& move_a, const MovedPrediction& move_b);

/// A root L of the covariance (C = L L') of numbers whose prior is normal with `prior_sigma`, when
/// what the data say in `covariance` is counted down by `temper`.
Eigen::MatrixXd tempered_root(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& prior_sigma,
                              double temper);

}  // namespace hoof::tools
