// What hypotheses as fitted say of planned recordings, in units of the noise.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/diagnose/experiment_candidates.h"
#include "tools/diagnose/experiment_design.h"
#include "tools/diagnose/separation.h"

namespace hoof::tools {

/// Noise of a channel as the fit recordings have it.
struct ChannelNoise {
  double sigma = 0;      // SI
  double effective = 1;  // share of the samples that are independent

  /// SI, of one in a whitened prediction.
  double unit() const { return sigma / std::sqrt(effective); }
};

class RivalPredictor {
 public:
  /// The given data sets with the candidates behind them, as one machine.
  RivalPredictor(const Fitter& fitter, const std::vector<DataSet>& sets,
                 const std::vector<Candidate>& candidates, const std::vector<Rival>& rivals);

  int rivals() const { return static_cast<int>(hypotheses_.size()); }
  /// Recordings that were made come first, candidates after them.
  int recordings_made() const { return made_; }
  const RigModel& model() const { return *model_; }
  const std::map<std::string, ChannelNoise>& noise() const { return noise_; }

  /// Channels of a recording that are weighed: those whose noise is known.
  std::vector<int> weighed(int recording) const;
  /// Independent samples of a recording, over all weighed channels.
  double independent(int recording) const;

  /// Of rival i, its numbers moved by u in the directions of its covariance; all channels, SI.
  Prediction predict(int rival, int recording, const Eigen::VectorXd& u) const;
  /// As it is fitted: where a torque drives an open loop, drawn to what was measured, or in a
  /// planned recording to the goal.
  Prediction predict(int rival, int recording) const;
  /// What the machine would do.
  Prediction predict_free(int rival, int recording) const;
  /// The weighed channels, divided by their noise.
  Eigen::VectorXd whitened(int recording, const Prediction& prediction) const;
  /// With slopes, by difference quotients.
  WhitePrediction sloped(int rival, int recording) const;

 private:
  struct Hypothesis {
    Layout layout;
    Eigen::VectorXd x;
    Eigen::MatrixXd root;  // of the covariance of x
  };

  void take_noise(const Fitter& fitter);
  void add_noise_of_others();

  std::unique_ptr<RigModel> model_;
  std::vector<Hypothesis> hypotheses_;
  std::map<std::string, ChannelNoise> noise_;
  int made_ = 0;
};

}  // namespace hoof::tools
