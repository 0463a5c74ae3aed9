// A quadratic in the factors, fitted to runs by least squares, and its analysis of variance.
//
//   y = b0 + sum b_i x_i + sum b_ij x_i x_j + sum b_ii x_i^2
// Sums of squares are partial ones (type III) in coded factors, as the usual programs print them:
// what the residual would gain if that term alone were left out.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/design_of_experiments/factor.h"

namespace hoof::tools {

enum class SurfaceModel { kLinear, kInteractions, kQuadratic };

/// Runs that were made: factors in natural units.
struct Runs {
  std::string source;  // for messages
  std::vector<std::vector<double>> factors;
  std::vector<double> response;
};

/// A row of the table. F and p are NaN where there are none.
struct VarianceRow {
  std::string source;
  double sum_of_squares = 0;
  int freedom = 0;
  double mean_square = 0, f = 0, p = 0;
};

class ResponseSurface {
 public:
  /// @throws UserError with fewer runs than terms, or runs that leave a term open
  ResponseSurface(std::vector<Factor> factors, const Runs& runs, SurfaceModel model);

  const std::vector<Factor>& factors() const { return factors_; }
  /// "1", "A", "A*B", "A^2".
  const std::vector<std::string>& terms() const { return terms_; }
  const Eigen::VectorXd& coded() const { return coded_; }
  Eigen::VectorXd natural() const;
  /// Standard errors of coded().
  Eigen::VectorXd coded_errors() const;

  const std::vector<VarianceRow>& variance() const { return rows_; }
  double r2() const { return r2_; }
  double adjusted_r2() const { return adjusted_r2_; }
  /// 1 - PRESS / total: each run foretold by the others. NaN where a run alone tells a term.
  double predicted_r2() const { return predicted_r2_; }
  /// Range of the predictions over their mean standard error (Design-Expert's); above 4 is enough.
  double adequate_precision() const { return adequate_precision_; }
  double residual_deviation() const { return residual_deviation_; }
  int residual_freedom() const { return residual_freedom_; }
  /// Predicted responses at the runs, and what is left.
  const Eigen::VectorXd& fitted() const { return fitted_; }
  const Eigen::VectorXd& residuals() const { return residuals_; }

  double at(const std::vector<double>& coded) const;
  /// Half of the 95 % interval of the mean response there, and of one new run.
  double mean_half95(const std::vector<double>& coded) const;
  double run_half95(const std::vector<double>& coded) const;

  /// Within the factors' bounds: the largest or smallest response. From many starts, one coordinate
  /// after the other. @return coded
  std::vector<double> optimum(bool largest) const;

 private:
  Eigen::VectorXd row(const std::vector<double>& coded) const;
  void name_terms();
  void analyse(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, const Runs& runs);
  double half95(double leverage) const;

  std::vector<Factor> factors_;
  SurfaceModel model_;
  std::vector<std::string> terms_;
  Eigen::VectorXd coded_, fitted_, residuals_;
  Eigen::MatrixXd inverse_;  // of X'X
  std::vector<VarianceRow> rows_;
  double r2_ = 0, adjusted_r2_ = 0, predicted_r2_ = 0, adequate_precision_ = 0;
  double residual_deviation_ = 0;
  int residual_freedom_ = 0;
};

}  // namespace hoof::tools
