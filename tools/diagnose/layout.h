// The search's own coordinates of a hypothesis: doubtful setup in its sigmas, then the parameters
// of each effect, by their logarithm where the catalogue says so, each with a normal prior.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/rig_model.h"

namespace hoof::tools {

using Effects = std::vector<const sim::EffectInfo*>;

/// "none", "backlash", "backlash+stribeck_friction"
std::string name_of(const Effects& effects);

class Layout {
 public:
  Layout(const RigModel& model, Effects effects);

  int size() const { return setup_count_ + static_cast<int>(coordinates_.size()); }
  int setup_count() const { return setup_count_; }
  const Effects& effects() const { return effects_; }

  /// SI values; clipped to the bounds.
  std::vector<double> setup(const Eigen::VectorXd& x) const;
  std::vector<ActiveEffect> active(const Eigen::VectorXd& x) const;
  double setup_value(int i, double x) const;
  double effect_value(int i, double x) const;  // i from 0 over all effects' parameters
  double coordinate(int i, double value) const;

  /// As stated, effects at their typical size.
  Eigen::VectorXd stated() const;

  double prior_mean(int i) const;
  double prior_sigma(int i) const;
  /// For difference quotients.
  double step(int i) const { return 0.02 * prior_sigma(i) < 0.02 ? 0.02 * prior_sigma(i) : 0.02; }

  /// All starts of the effects, as whole coordinate vectors about `x`'s setup; and which coordinate
  /// is the effect's size, -1 for none. Of a single effect.
  struct Start {
    Eigen::VectorXd x;
    int size_coordinate = -1;
    int phase_coordinate = -1;
  };
  std::vector<Start> starts(const Eigen::VectorXd& setup_x) const;

  struct Coordinate {
    const sim::EffectParameter* parameter = nullptr;
    double unit = 1;
  };
  const Coordinate& of_effect(int i) const { return coordinates_[i]; }

 private:
  const RigModel* model_;
  Effects effects_;
  int setup_count_;
  std::vector<Coordinate> coordinates_;
};

}  // namespace hoof::tools
