#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/conceal/case_reader.h"

namespace hoof::tools::conceal {

/// A case as a regression: what is measured (torque or force) against what the nominal model is
/// linear in, and what each effect would add. One row per sample, thinned to about a thousand.
struct RegressionProblem {
  Eigen::VectorXd measured;
  Eigen::MatrixXd nominal;
  struct Feature {
    std::string effect;
    Eigen::MatrixXd columns;
  };
  std::vector<Feature> dictionary;
  Eigen::MatrixXd state;  ///< (q, w) or (depth, breadth), for the Gaussian process
};

/// Only the recordings that are there to be fitted.
RegressionProblem regression_of(const ReadCase& data);

/// What is left of `measured` by least squares.
Eigen::VectorXd left_over(const Eigen::MatrixXd& columns, const Eigen::VectorXd& measured);

/// Baseline: sparse regression of the equation error. Takes up to two effects whose features lower
/// the BIC by more than ten each; "none", "a" or "a+b".
std::string pick_by_sparse_regression(const RegressionProblem& problem);

/// Baseline: "unknown" where a Gaussian process of the state explains what the nominal model leaves
/// better than noise does, by a factor of e^5 in evidence; else "none".
std::string pick_by_gaussian_process(const RegressionProblem& problem);

}  // namespace hoof::tools::conceal
