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

/// What a residual counts at most, in sigmas: a rollout that fell over must not hide all else.
constexpr double kLargest = 1e3;

class Cost final : public ceres::CostFunction {
 public:
  Cost(const Fitter& fitter, const Layout& layout, int residuals)
      : fitter_(fitter), layout_(layout) {
    set_num_residuals(residuals);
    mutable_parameter_block_sizes()->push_back(layout.size());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], layout_.size());
    const Eigen::VectorXd r = fitter_.residuals(layout_, x);
    std::copy(r.data(), r.data() + r.size(), residuals);
    if (jacobians && jacobians[0]) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor>(jacobians[0], r.size(), layout_.size()) =
          fitter_.jacobian(layout_, x, r);
    }
    return true;
  }

 private:
  const Fitter& fitter_;
  const Layout& layout_;
};

}  // namespace

Fitter::Fitter(const RigModel& model) : model_(&model) {
  for (int i = 0; i < model.recordings(); ++i) {
    const Recording& recording = model.recording(i);
    for (std::size_t c = 0; c < model.channels(i).size(); ++c) {
      const std::string& name = model.channels(i)[c];
      const auto& values = recording.channels.at(name);
      Group group{i, static_cast<int>(c), recording.holdout, 0, 0, 1, 0};
      for (const double v : values) group.samples += std::isfinite(v) ? 1 : 0;
      const double seen = estimate_noise(recording.time_s, values);
      const double stated = model.stated_noise(i, name);
      group.noise =
          std::max({stated, seen > 0 && stated <= 0 ? seen : 0.0, 1e-4 * rms(values), 1e-12});
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

Eigen::VectorXd Fitter::residuals(const Layout& layout, const Eigen::VectorXd& x) const {
  const std::vector<double> setup = layout.setup(x);
  const std::vector<ActiveEffect> active = layout.active(x);
  std::vector<double> all;
  Prediction prediction;
  int predicted = -1;
  for (const Group& group : groups_) {
    if (group.holdout) continue;
    if (group.recording != predicted) {
      prediction = model_->predict(group.recording, setup, active, Rollout::kCorrected);
      predicted = group.recording;
    }
    const double weight = std::sqrt(group.effective) / group.sigma;
    const double most = kLargest * std::sqrt(group.effective);
    const std::string& name = model_->channels(group.recording)[group.channel];
    const auto& measured = model_->recording(group.recording).channels.at(name);
    const auto& values = prediction[group.channel];
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const double difference = (measured[i] - values[i]) * weight;
      const bool missing = !std::isfinite(measured[i]);
      all.push_back(missing                     ? 0
                    : std::isfinite(difference) ? std::clamp(difference, -most, most)
                                                : most);
    }
  }
  const auto samples = static_cast<Eigen::Index>(all.size());
  Eigen::VectorXd r(samples + layout.size());
  r.head(samples) = Eigen::Map<Eigen::VectorXd>(all.data(), samples);
  for (int i = 0; i < layout.size(); ++i) {
    r[samples + i] = (x[i] - layout.prior_mean(i)) / layout.prior_sigma(i);
  }
  return r;
}

Eigen::MatrixXd Fitter::jacobian(const Layout& layout, const Eigen::VectorXd& x,
                                 const Eigen::VectorXd& r) const {
  Eigen::MatrixXd J(r.size(), layout.size());
  for (int i = 0; i < layout.size(); ++i) {
    Eigen::VectorXd shifted = x;
    shifted[i] += layout.step(i);
    J.col(i) = (residuals(layout, shifted) - r) / layout.step(i);
  }
  return J;
}

Fit Fitter::fit(const Effects& effects, const Eigen::VectorXd& start, int iterations) const {
  const Layout layout(*model_, effects);
  Fit fit;
  fit.effects = effects;
  fit.x = start;
  if (layout.size() > 0 && iterations > 0) {
    const auto count = static_cast<int>(residuals(layout, start).size());
    ceres::Problem problem;
    problem.AddResidualBlock(new Cost(*this, layout, count), nullptr, fit.x.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-5;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    fit.objective = summary.final_cost;
  } else {
    fit.objective = 0.5 * residuals(layout, start).squaredNorm();
  }
  return fit;
}

void Fitter::judge(Fit& fit) const {
  const Layout layout(*model_, fit.effects);
  const Eigen::VectorXd r = residuals(layout, fit.x);
  const Eigen::MatrixXd J = jacobian(layout, fit.x, r);
  const int k = layout.size();
  fit.objective = 0.5 * r.squaredNorm();
  fit.log_likelihood = -0.5 * r.head(r.size() - k).squaredNorm();
  fit.log_evidence = -fit.objective;
  if (k > 0) {
    const Eigen::MatrixXd H = J.transpose() * J;  // priors are rows of J
    const Eigen::LDLT<Eigen::MatrixXd> ldlt(H);
    fit.covariance = ldlt.solve(Eigen::MatrixXd::Identity(k, k));
    fit.log_evidence -= 0.5 * ldlt.vectorD().array().max(1e-12).log().sum();
    for (int i = 0; i < k; ++i) fit.log_evidence -= std::log(layout.prior_sigma(i));
  }
  fit.squares.clear();
  Prediction prediction;
  int predicted = -1;
  for (const Group& group : groups_) {
    if (group.recording != predicted) {
      prediction = predict(fit, group.recording, Rollout::kCorrected);
      predicted = group.recording;
    }
    double sum = 0;
    for (const double d : differences(group, prediction[group.channel])) {
      if (std::isfinite(d)) sum += d * d;
    }
    fit.squares.push_back(sum);
  }
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
