#include "tools/diagnose/damped_fit.h"

#include <Eigen/Dense>

namespace hoof::tools {
Fit damped_fit(const Fitter& fitter, Fit fit, int iterations, const Fitter::Weights& weights,
               int held) {
  constexpr double kFirstDamping = 0.03, kMore = 8, kLess = 0.2, kEnough = 1e-3;
  constexpr int kTries = 5;
  const Layout layout(fitter.model(), fit.effects);
  Eigen::VectorXd r = fitter.residuals(layout, fit.x, weights);
  fit.objective = 0.5 * r.squaredNorm();
  double damping = kFirstDamping;
  for (int i = 0; i < iterations && layout.size() > 0; ++i) {
    const Eigen::MatrixXd J = fitter.jacobian(layout, fit.x, r, weights, held);
    const Eigen::MatrixXd H = J.transpose() * J;
    const Eigen::VectorXd slope = J.transpose() * r;
    double gained = 0;
    for (int k = 0; k < kTries && gained <= 0; ++k) {
      Eigen::MatrixXd A = H;
      A.diagonal() += damping * H.diagonal().cwiseMax(1e-12);
      const Eigen::VectorXd x = fit.x - A.ldlt().solve(slope);
      const Eigen::VectorXd there = fitter.residuals(layout, x, weights);
      const double objective = 0.5 * there.squaredNorm();
      if (objective < fit.objective) {
        gained = fit.objective - objective;
        fit.x = x, r = there, fit.objective = objective;
        damping *= kLess;
      } else {
        damping *= kMore;
      }
    }
    if (gained <= kEnough * fit.objective) break;
  }
  return fit;
}

}  // namespace hoof::tools
