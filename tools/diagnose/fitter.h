// Hypotheses against recordings: residuals in units of their noise, least squares, evidence.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/diagnose/layout.h"

namespace hoof::tools {

/// One channel of one recording: its noise and how much of its samples counts.
struct Group {
  int recording = 0;
  int channel = 0;  // in RigModel::channels
  bool holdout = false;
  double noise = 0;      // of the sensor, SI
  double sigma = 0;      // what residuals are divided by
  double effective = 1;  // share of the samples that are independent
  double samples = 0;    // that are there
};

struct Fit {
  Effects effects;
  Eigen::VectorXd x;
  double objective = 0;         // half the sum of squares, priors included
  std::vector<double> squares;  // by group: sum of squared residuals, SI
  Eigen::MatrixXd covariance;   // of x
  double log_evidence = 0;      // Laplace, up to a constant common to all hypotheses
  double log_likelihood = 0;    // of the fit recordings, at the groups' sigma
};

class Fitter {
 public:
  explicit Fitter(const RigModel& model);

  const RigModel& model() const { return *model_; }
  std::vector<Group>& groups() { return groups_; }
  const std::vector<Group>& groups() const { return groups_; }

  /// All residuals of the fit recordings over sigma, times the root of `effective`, and after them
  /// the priors'. A model that runs away gives large ones.
  Eigen::VectorXd residuals(const Layout& layout, const Eigen::VectorXd& x) const;
  Eigen::MatrixXd jacobian(const Layout& layout, const Eigen::VectorXd& x,
                           const Eigen::VectorXd& r) const;

  /// Least squares from x. @param iterations at most
  Fit fit(const Effects& effects, const Eigen::VectorXd& x, int iterations) const;
  /// Covariance, evidence, squares by group at fit.x.
  void judge(Fit& fit) const;

  /// Sum of squares of a group, SI, in a rollout; and the differences themselves.
  std::vector<double> differences(const Group& group, const std::vector<double>& predicted) const;
  /// Predictions of all groups of a recording.
  Prediction predict(const Fit& fit, int recording, Rollout rollout) const;

 private:
  const RigModel* model_;
  std::vector<Group> groups_;
};

/// Runs task(0..count-1) on some threads; the first exception is thrown on.
void for_each_task(int count, int threads, const std::function<void(int)>& task);

}  // namespace hoof::tools
