#include "tools/diagnose/rollout_errors.h"

#include <cmath>
#include <numbers>

namespace hoof::tools {
namespace {

struct Sum {
  double squares = 0, count = 0;
};

Errors root_means(const std::map<std::string, Sum>& sums) {
  Errors errors;
  for (const auto& [channel, sum] : sums) {
    if (sum.count > 0) errors[channel + "_rmse"] = std::sqrt(sum.squares / sum.count);
  }
  return errors;
}

}  // namespace

Rollouts roll_out(const Fitter& fitter, const Fit& fit, int threads) {
  const RigModel& model = fitter.model();
  Rollouts rollouts;
  rollouts.predictions.resize(model.recordings());
  for_each_task(model.recordings(), threads,
                [&](int i) { rollouts.predictions[i] = fitter.predict(fit, i, Rollout::kFree); });
  std::map<std::string, Sum> sums[2];
  for (const Group& group : fitter.groups()) {
    Sum& sum = sums[group.holdout ? 1 : 0][model.channels(group.recording)[group.channel]];
    const auto& predicted = rollouts.predictions[group.recording][group.channel];
    for (const double d : fitter.differences(group, predicted)) {
      if (std::isfinite(d)) sum.squares += d * d, sum.count += 1;
    }
  }
  rollouts.errors = {root_means(sums[0]), root_means(sums[1])};
  return rollouts;
}

Errors noise_floor(const Fitter& fitter) {
  std::map<std::string, Sum> sums;
  for (const Group& group : fitter.groups()) {
    Sum& sum = sums[fitter.model().channels(group.recording)[group.channel]];
    sum.squares += group.noise * group.noise * group.samples;
    sum.count += group.samples;
  }
  return root_means(sums);
}

Fit without_effect(const RigModel& model, const Fit& fit, std::size_t k) {
  Fit less;
  int at = Layout(model, {}).setup_count();
  std::vector<double> x(fit.x.data(), fit.x.data() + at);
  for (std::size_t i = 0; i < fit.effects.size(); ++i) {
    const int size = static_cast<int>(fit.effects[i]->parameters.size());
    if (i != k) {
      less.effects.push_back(fit.effects[i]);
      x.insert(x.end(), fit.x.data() + at, fit.x.data() + at + size);
    }
    at += size;
  }
  less.x = Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  return less;
}

double plain_log_likelihood(const Fitter& fitter, const Fit& fit) {
  double sum = 0;
  for (std::size_t g = 0; g < fitter.groups().size(); ++g) {
    const Group& group = fitter.groups()[g];
    if (group.holdout || group.samples < 1) continue;
    const double variance = std::max(fit.squares[g] / group.samples, 1e-300);
    sum -= 0.5 * group.samples * (std::log(2 * std::numbers::pi * variance) + 1);
  }
  return sum;
}

}  // namespace hoof::tools
