#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/conceal/servo_plan.h"

namespace hoof::tools::conceal {

/// How far something hidden changes what is recorded, in deviations of the noise.
struct ChannelChange {
  std::string channel;
  double raw = 0.0;          ///< rms
  double after_refit = 0.0;  ///< rms of what wrong parameters of the nominal model cannot explain
};

struct SeenChange {
  std::vector<ChannelChange> channels;
  /// Root of the sum of squares over all samples and channels, after the refit.
  double strength = 0.0;
  const ChannelChange& main() const;  ///< the largest after refit
};

/// All predicted channels of all recordings, each over its noise, in one column.
Eigen::VectorXd whitened(const ServoPlan& plan, const std::vector<ServoSignals>& signals);

/// Sensitivities about `hidden`: one column for each doubtful parameter, per sigma of its doubt,
/// and one for each parameter of `free_effects`, per tenth of its value, with no doubt known.
struct Sensitivities {
  Eigen::MatrixXd columns;
  Eigen::VectorXd ridge;  ///< 1 where the column has a known doubt, 0 where it is free
};
Sensitivities sensitivities(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                            const std::vector<HiddenEffect>& free_effects,
                            const Eigen::VectorXd& base);

/// `channels` have the same number of samples each, one after the other in `change`.
SeenChange seen_change(const std::vector<std::string>& channels, const Eigen::VectorXd& change,
                       const Sensitivities& explained);
SeenChange seen_change(const ServoPlan& plan, const Eigen::VectorXd& change,
                       const Sensitivities& explained);

}  // namespace hoof::tools::conceal
