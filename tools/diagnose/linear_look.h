// What an effect beside a fit would do, to first order, from one rollout: at which size, with all
// that was fitted refitted.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

/// One start of one effect.
struct LinearStart {
  const sim::EffectInfo* effect = nullptr;
  Eigen::VectorXd own;  // its coordinates
  int size = -1;        // which of them is its size; -1: none, it is as large as it starts
  int phase = -1;
  bool by_log = false;
  double gain = 0;  // beside some base
};

std::vector<LinearStart> starts_of(const RigModel& model, const sim::EffectInfo* effect);

/// The way from a base to where a linear step would go.
struct LinearStep {
  Effects effects;         // the base's and one more
  Eigen::VectorXd from;    // with the effect at full size
  Eigen::VectorXd change;  // of the coordinates of the base
  int size_coordinate = -1;
  bool by_log = false;
  double gain = 0;  // by which half the sum of squares would fall
};

/// A fit, and what its residuals do when its own coordinates move.
class LinearBase {
 public:
  LinearBase(const Fitter& fitter, Fit base, Fitter::Weights weights);

  /// One rollout. Gain 0 where a step makes no sense.
  LinearStep beside(const LinearStart& start) const;

  /// The point on the way, of some, that leaves least: a linear step may go too far. Effects in
  /// the order of their names, so that both ways to a pair are one hypothesis.
  Fit least_along(const LinearStep& step) const;

 private:
  Eigen::VectorXd at(const LinearStep& step, double share) const;

  const Fitter& fitter_;
  Fit base_;
  Fitter::Weights weights_;
  Eigen::VectorXd r_;  // without priors
  Eigen::MatrixXd J_;  // priors of the base's coordinates in the last rows
  Eigen::VectorXd prior_;
};

}  // namespace hoof::tools
