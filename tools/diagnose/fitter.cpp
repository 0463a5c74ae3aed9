#include "tools/diagnose/fitter.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "tools/diagnose/noise.h"

namespace hoof::tools {
namespace {

/// Residuals larger than this many sigmas are bent to grow by their root.
constexpr double kBend = 10;
constexpr double kLargest = 1e6;  // where a model runs away
/// A rollout is lost where it is this many deviations of the noise off, and this long after.
constexpr double kLost = 40;
constexpr double kAfterLoss_s = 0.2;

double bent(double r) {
  const double size = std::abs(r);
  if (size <= kBend) return r;
  return std::copysign(std::sqrt(2 * kBend * std::min(size, kLargest) - kBend * kBend), r);
}

class Cost final : public ceres::CostFunction {
 public:
  Cost(const Fitter& fitter, const Layout& layout, const Fitter::Weights& weights, int residuals)
      : fitter_(fitter), layout_(layout), weights_(weights) {
    set_num_residuals(residuals);
    mutable_parameter_block_sizes()->push_back(layout.size());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], layout_.size());
    const Eigen::VectorXd r = fitter_.residuals(layout_, x, weights_);
    std::copy(r.data(), r.data() + r.size(), residuals);
    if (jacobians && jacobians[0]) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], r.size(), layout_.size()) =
          fitter_.jacobian(layout_, x, r, weights_);
    }
    return true;
  }

 private:
  const Fitter& fitter_;
  const Layout& layout_;
  const Fitter::Weights& weights_;
};

}  // namespace

Fitter::Fitter(const RigModel& model) : model_(&model) {
  for (int i = 0; i < model.recordings(); ++i) {
    const Recording& recording = model.recording(i);
    for (std::size_t c = 0; c < model.channels(i).size(); ++c) {
      const std::string& name = model.channels(i)[c];
      const auto& values = recording.channels.at(name);
      Group group{.recording = i, .channel = static_cast<int>(c), .holdout = recording.holdout};
      for (const double v : values) group.samples += std::isfinite(v) ? 1 : 0;
      const double seen = estimate_noise(recording.time_s, values);
      const double stated = model.stated_noise(i, name);
      // A drive hands the noise of its sensor on to its torque: what is seen may be more than what
      // is stated of the sensor alone.
      group.noise = std::max({stated, seen, 1e-4 * rms(values), 1e-12});
      group.floor = std::hypot(group.noise, model.input_noise(i, name));
      group.sigma = group.noise;
      groups_.push_back(group);
    }
  }
}

std::vector<double> Fitter::differences(const Group& group,
                                        const std::vector<double>& predicted) const {
  const std::string& name = model_->channels(group.recording)[group.channel];
  const auto& measured = model_->recording(group.recording).channels.at(name);
  std::vector<double> d(measured.size());
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = measured[i] - predicted[i];
  return d;
}

Prediction Fitter::predict(const Fit& fit, int recording, Rollout rollout) const {
  const Layout layout(*model_, fit.effects);
  return model_->predict(recording, layout.setup(fit.x), layout.active(fit.x), rollout);
}

Fitter::Weights Fitter::weights() const {
  Weights weights;
  for (const Group& g : groups_) weights.scale.push_back(std::sqrt(g.effective) / g.sigma);
  return weights;
}

Fitter::Weights Fitter::roomy_weights(const std::vector<double>& squares, double share) const {
  Weights weights;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const double misfit = std::sqrt(squares[i] / std::max(g.samples, 1.0));
    weights.scale.push_back(1 / std::max(g.noise, share * misfit));
  }
  return weights;
}

std::vector<std::size_t> Fitter::followed_until(const Fit& fit) const {
  std::vector<std::size_t> until;
  for (int i = 0; i < model_->recordings(); ++i) {
    const std::vector<double>& t = model_->recording(i).time_s;
    const Prediction p = predict(fit, i, Rollout::kCorrected);
    std::size_t last = t.size();
    for (const Group& g : groups_) {
      if (g.recording != i) continue;
      const std::vector<double> d = differences(g, p[g.channel]);
      for (std::size_t k = 0; k < last; ++k) {
        if (std::abs(d[k]) > kLost * g.noise) last = k;
      }
    }
    const double end_s = last < t.size() ? t[last] + kAfterLoss_s : t.back();
    while (last < t.size() && t[last] < end_s) ++last;
    until.push_back(last);
  }
  return until;
}

Eigen::VectorXd Fitter::residuals(const Layout& layout, const Eigen::VectorXd& x,
                                  const Weights& weights) const {
  Eigen::Index samples = 0;
  for (const Group& group : groups_) {
    const std::string& name = model_->channels(group.recording)[group.channel];
    const auto& measured = model_->recording(group.recording).channels.at(name);
    if (!group.holdout) samples += static_cast<Eigen::Index>(measured.size());
  }
  Eigen::VectorXd r(samples + layout.size());
  fill(layout, x, weights, -1, r);
  return r;
}

/// @param only the recording to predict anew, the others' rows stay; -1: all
void Fitter::fill(const Layout& layout, const Eigen::VectorXd& x, const Weights& weights, int only,
                  Eigen::VectorXd& r) const {
  const std::vector<double> setup = layout.setup(x);
  const std::vector<ActiveEffect> active = layout.active(x);
  Prediction prediction;
  int predicted = -1;
  Eigen::Index row = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const Group& group = groups_[g];
    if (group.holdout) continue;
    const std::string& name = model_->channels(group.recording)[group.channel];
    const auto& measured = model_->recording(group.recording).channels.at(name);
    if (only >= 0 && group.recording != only) {
      row += static_cast<Eigen::Index>(measured.size());
      continue;
    }
    if (group.recording != predicted) {
      prediction = model_->predict(group.recording, setup, active, Rollout::kCorrected);
      predicted = group.recording;
    }
    const auto& values = prediction[group.channel];
    const std::size_t until =
        weights.until.empty() ? measured.size() : weights.until[group.recording];
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const double difference = (measured[i] - values[i]) * weights.scale[g];
      const bool missing = !std::isfinite(measured[i]) || i >= until;
      r[row++] = missing ? 0 : std::isfinite(difference) ? bent(difference) : bent(kLargest);
    }
  }
  for (int i = 0; i < layout.size(); ++i) {
    r[row + i] = (x[i] - layout.prior_mean(i)) / layout.prior_sigma(i);
  }
}

Eigen::MatrixXd Fitter::jacobian(const Layout& layout, const Eigen::VectorXd& x,
                                 const Eigen::VectorXd& r, const Weights& weights, int held) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(r.size(), layout.size());
  for (int i = 0; i < layout.size(); ++i) {
    if (i == held) continue;
    Eigen::VectorXd shifted = x, there = r;
    shifted[i] += layout.step(i);
    const bool setup = i < layout.setup_count();
    fill(layout, shifted, weights, setup ? model_->doubtful()[i].recording : -1, there);
    J.col(i) = (there - r) / layout.step(i);
  }
  return J;
}

double Fitter::objective(const Effects& effects, const Eigen::VectorXd& x,
                         const Weights& weights) const {
  return 0.5 * residuals(Layout(*model_, effects), x, weights).squaredNorm();
}

Fit Fitter::fit(const Effects& effects, const Eigen::VectorXd& start, int iterations,
                const Weights& weights, double tolerance) const {
  const Layout layout(*model_, effects);
  Fit fit;
  fit.effects = effects;
  fit.x = start;
  if (layout.size() == 0 || iterations == 0) {
    fit.objective = objective(effects, start, weights);
    return fit;
  }
  const auto count = static_cast<int>(residuals(layout, start, weights).size());
  ceres::Problem problem;
  problem.AddResidualBlock(new Cost(*this, layout, weights, count), nullptr, fit.x.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  fit.objective = summary.final_cost;
  return fit;
}

std::vector<double> Fitter::squares(const Fit& fit, const std::vector<std::size_t>& until) const {
  std::vector<double> squares;
  Prediction prediction;
  int predicted = -1;
  for (const Group& group : groups_) {
    if (group.recording != predicted) {
      prediction = predict(fit, group.recording, Rollout::kCorrected);
      predicted = group.recording;
    }
    double sum = 0;
    const std::vector<double> d = differences(group, prediction[group.channel]);
    const std::size_t end = until.empty() ? d.size() : until[group.recording];
    for (std::size_t i = 0; i < end; ++i) {
      if (std::isfinite(d[i])) sum += d[i] * d[i];
    }
    squares.push_back(sum);
  }
  return squares;
}

void Fitter::judge(Fit& fit) const {
  const Layout layout(*model_, fit.effects);
  const Weights w = weights();
  const Eigen::VectorXd r = residuals(layout, fit.x, w);
  const Eigen::MatrixXd J = jacobian(layout, fit.x, r, w);
  const int k = layout.size();
  fit.objective = 0.5 * r.squaredNorm();
  fit.log_likelihood = -0.5 * r.head(r.size() - k).squaredNorm();
  fit.log_evidence = -fit.objective;
  for (const sim::EffectInfo* effect : fit.effects) {
    fit.log_evidence -= model_->complexity(*effect);
  }
  if (k > 0) {
    const Eigen::MatrixXd H = J.transpose() * J;  // priors are rows of J
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(H);
    fit.covariance = ldlt.solve(Eigen::MatrixXd::Identity(k, k));
    fit.log_evidence -= 0.5 * ldlt.vectorD().array().max(1e-12).log().sum();
    for (int i = 0; i < k; ++i) fit.log_evidence -= std::log(layout.prior_sigma(i));
  }
  fit.squares = squares(fit);
}

void for_each_task(int count, int threads, const std::function<void(int)>& task) {
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < std::min(threads, count); ++i) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace hoof::tools
