#include "tools/diagnose/rival_predictor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/diagnose/noise.h"
#include "tools/diagnose/series.h"

namespace hoof::tools {
namespace {

/// Variances of a fit count four times: a model's own errors look like no noise. (Reported
/// intervals are wider still, diagnose.cpp: they are to hold the truth, these are to rank
/// experiments.)
constexpr double kTemperOfIntervals = 4;
/// Of a channel's range: no sensor is better.
constexpr double kLeastNoise = 1e-4;

Eigen::VectorXd prior_sigmas(const Layout& layout) {
  Eigen::VectorXd sigma(layout.size());
  for (int i = 0; i < layout.size(); ++i) sigma[i] = layout.prior_sigma(i);
  return sigma;
}

std::unique_ptr<RigModel> with_candidates(const std::vector<DataSet>& sets,
                                          const std::vector<Candidate>& candidates) {
  std::vector<DataSet> all = sets;
  for (const Candidate& c : candidates) all.push_back(c.set);
  return make_rig_model(all);
}

}  // namespace

RivalPredictor::RivalPredictor(const Fitter& fitter, const std::vector<DataSet>& sets,
                               const std::vector<Candidate>& candidates,
                               const std::vector<Rival>& rivals)
    : model_(with_candidates(sets, candidates)), made_(fitter.model().recordings()) {
  const auto& before = fitter.model().doubtful();
  const auto& now = model_->doubtful();
  const auto known = static_cast<int>(before.size()), all = static_cast<int>(now.size());
  for (int i = 0; i < known; ++i) {
    // A rig's model lists what the data sets doubt in their order.
    if (i >= all || now[i].name != before[i].name) throw std::logic_error("doubts changed places");
  }
  for (const Rival& rival : rivals) {
    const Fit& fit = *rival.fit;
    Hypothesis h{Layout(*model_, fit.effects), {}, {}};
    const int effect = h.layout.size() - all;
    // What only a planned recording doubts, such as another payload, stands between the two.
    h.x = Eigen::VectorXd::Zero(h.layout.size());
    h.x.head(known) = fit.x.head(known);
    h.x.tail(effect) = fit.x.tail(effect);
    const Layout of_fit(fitter.model(), fit.effects);
    const Eigen::MatrixXd root =
        tempered_root(fit.covariance, prior_sigmas(of_fit), kTemperOfIntervals);
    h.root = Eigen::MatrixXd::Zero(h.layout.size(), h.layout.size());
    h.root.block(0, 0, known, known + effect) = root.topRows(known);
    h.root.block(all, 0, effect, known + effect) = root.bottomRows(effect);
    for (int i = known; i < all; ++i) h.root(i, effect + i) = 1;
    hypotheses_.push_back(std::move(h));
  }
  take_noise(fitter);
}

void RivalPredictor::take_noise(const Fitter& fitter) {
  std::map<std::string, double> count;
  for (const Group& g : fitter.groups()) {
    if (g.holdout || g.samples < 1) continue;
    const std::string& name = fitter.model().channels(g.recording)[g.channel];
    ChannelNoise& noise = noise_.try_emplace(name, ChannelNoise{0, 0}).first->second;
    noise.sigma += g.sigma * g.sigma;
    noise.effective += g.effective;
    count[name] += 1;
  }
  for (auto& [name, noise] : noise_) {
    noise.sigma = std::sqrt(noise.sigma / count[name]);
    noise.effective /= count[name];
  }
  add_noise_of_others();
}

/// Of channels that were recorded but not predicted, as heights are on sand: a block's are.
void RivalPredictor::add_noise_of_others() {
  double effective = 1;
  for (const auto& [name, noise] : noise_) effective = std::min(effective, noise.effective);
  std::map<std::string, ChannelNoise> others;
  for (int planned = made_; planned < model_->recordings(); ++planned) {
    for (const std::string& name : model_->channels(planned)) {
      if (noise_.contains(name) || others.contains(name)) continue;
      double sigma = 0;
      for (int i = 0; i < made_; ++i) {
        const Recording& r = model_->recording(i);
        if (!r.has(name)) continue;
        const Series& values = r.channels.at(name);
        sigma = std::max({sigma, model_->stated_noise(i, name), estimate_noise(r.time_s, values),
                          kLeastNoise * range_of(values)});
      }
      if (sigma > 0) others[name] = {sigma, effective};
    }
  }
  noise_.merge(others);
}

std::vector<int> RivalPredictor::weighed(int recording) const {
  std::vector<int> channels;
  const auto& names = model_->channels(recording);
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (noise_.contains(names[c])) channels.push_back(static_cast<int>(c));
  }
  return channels;
}

double RivalPredictor::independent(int recording) const {
  double sum = 0;
  const auto count = static_cast<double>(model_->recording(recording).time_s.size());
  for (const int c : weighed(recording)) {
    sum += count * noise_.at(model_->channels(recording)[c]).effective;
  }
  return sum;
}

Prediction RivalPredictor::predict(int rival, int recording, const Eigen::VectorXd& u) const {
  const Hypothesis& h = hypotheses_[rival];
  const Eigen::VectorXd x = h.x + h.root * u;
  return model_->predict(recording, h.layout.setup(x), h.layout.active(x), Rollout::kCorrected);
}

Prediction RivalPredictor::predict(int rival, int recording) const {
  return predict(rival, recording, Eigen::VectorXd::Zero(hypotheses_[rival].root.cols()));
}

Prediction RivalPredictor::predict_free(int rival, int recording) const {
  const Hypothesis& h = hypotheses_[rival];
  return model_->predict(recording, h.layout.setup(h.x), h.layout.active(h.x), Rollout::kFree);
}

Eigen::VectorXd RivalPredictor::whitened(int recording, const Prediction& prediction) const {
  const std::vector<int> channels = weighed(recording);
  const auto count = static_cast<Eigen::Index>(model_->recording(recording).time_s.size());
  Eigen::VectorXd y(count * static_cast<Eigen::Index>(channels.size()));
  Eigen::Index at = 0;
  for (const int c : channels) {
    const double unit = noise_.at(model_->channels(recording)[c]).unit();
    // Missing is missing for all hypotheses: no difference.
    for (const double v : prediction[c]) y[at++] = std::isfinite(v) ? v / unit : 0;
  }
  return y;
}

WhitePrediction RivalPredictor::sloped(int rival, int recording) const {
  const Hypothesis& h = hypotheses_[rival];
  WhitePrediction white{whitened(recording, predict(rival, recording)), {}};
  Eigen::MatrixXd J(white.y.size(), h.x.size());
  for (int i = 0; i < h.layout.size(); ++i) {
    Eigen::VectorXd x = h.x;
    x[i] += h.layout.step(i);
    const Prediction p =
        model_->predict(recording, h.layout.setup(x), h.layout.active(x), Rollout::kCorrected);
    J.col(i) = (whitened(recording, p) - white.y) / h.layout.step(i);
  }
  white.M = J * h.root;
  return white;
}

}  // namespace hoof::tools
