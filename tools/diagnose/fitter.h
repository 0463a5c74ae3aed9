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
  double floor = 0;      // what a perfect model leaves: noise, and what noise of the inputs makes
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

  /// How differences count.
  struct Weights {
    std::vector<double> scale;       // by group, what they are multiplied by
    std::vector<std::size_t> until;  // by recording, the first sample that does not; empty: all do
  };
  /// The root of `effective` over sigma.
  Weights weights() const;
  /// The same with room for a misfit: sigma no less than `share` of what `squares` leave.
  Weights roomy_weights(const std::vector<double>& squares, double share) const;

  /// By recording the sample until which a fit follows it, and some time more: where a rollout has
  /// gone another way, as a free swing does, its differences lead a search astray.
  std::vector<std::size_t> followed_until(const Fit& fit) const;

  /// All residuals of the fit recordings, weighted, and after them the priors'. Beyond kBend they
  /// grow by the root only: a rollout that went another way must not hide all else.
  Eigen::VectorXd residuals(const Layout& layout, const Eigen::VectorXd& x,
                            const Weights& weights) const;
  /// @param held a coordinate whose column stays zero, and costs no rollout; -1: none
  Eigen::MatrixXd jacobian(const Layout& layout, const Eigen::VectorXd& x, const Eigen::VectorXd& r,
                           const Weights& weights, int held = -1) const;

  /// Least squares from x. @param iterations at most
  Fit fit(const Effects& effects, const Eigen::VectorXd& x, int iterations, const Weights& weights,
          double tolerance = 1e-5) const;
  /// Half the sum of squares at x.
  double objective(const Effects& effects, const Eigen::VectorXd& x, const Weights& weights) const;
  /// Sum of squared differences by group, SI.
  /// @param until as of Weights
  std::vector<double> squares(const Fit& fit, const std::vector<std::size_t>& until = {}) const;
  /// Covariance, evidence, squares by group at fit.x.
  void judge(Fit& fit) const;

  /// Sum of squares of a group, SI, in a rollout; and the differences themselves.
  std::vector<double> differences(const Group& group, const std::vector<double>& predicted) const;
  /// Predictions of all groups of a recording.
  Prediction predict(const Fit& fit, int recording, Rollout rollout) const;

 private:
  void fill(const Layout& layout, const Eigen::VectorXd& x, const Weights& weights, int only,
            Eigen::VectorXd& r) const;

  const RigModel* model_;
  std::vector<Group> groups_;
};

/// Runs task(0..count-1) on some threads; the first exception is thrown on.
void for_each_task(int count, int threads, const std::function<void(int)>& task);

}  // namespace hoof::tools
