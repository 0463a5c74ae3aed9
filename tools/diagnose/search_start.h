// Where a search for an effect begins: every start of it scored by what it would gain.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fitter.h"

namespace hoof::tools {

struct SearchStart {
  Effects effects;
  Eigen::VectorXd x;
  /// By how much the base's own coordinates give way to the effect at this size, linearly.
  Eigen::VectorXd give;
  double gain = 0;  // by which half the sum of squares would fall, linearly
  int size_coordinate = -1;
  bool by_log = false;
  bool sized = false;                        // x is fitted roughly already
  const Fitter::Weights* weights = nullptr;  // of the first rough fit, where not the usual ones
};

/// Residuals of a fit and a basis of what its own parameters can do.
struct Tangent {
  Eigen::VectorXd r;
  Eigen::MatrixXd basis;
  Eigen::MatrixXd inverse;  // residuals to coordinates, priors heeded
};

Tangent tangent(const Fitter& fitter, const Fit& fit, const Fitter::Weights& weights);

/// Starts of `effect` beside a fit, each at the size that a linear step asks for, best first.
std::vector<SearchStart> starts_beside(const Fitter& fitter, const Fit& base,
                                       const Tangent& tangent, const sim::EffectInfo* effect,
                                       const Fitter::Weights& weights);

/// Coordinates of the hypothesis `to`: the setup, and the effects that `from` has too, as they are
/// there, others from `x`.
Eigen::VectorXd carried(const RigModel& model, const Fit& from, const Effects& to,
                        Eigen::VectorXd x);

/// All of `some` are among `all`.
bool part_of(const Effects& some, const Effects& all);

/// No stand-in for physics outside the list among them.
bool listed(const Effects& effects);

}  // namespace hoof::tools
