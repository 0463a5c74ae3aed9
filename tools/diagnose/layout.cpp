#include "tools/diagnose/layout.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools {
namespace {

/// Of a prior over a logarithm: a factor of 4.5 either way is one sigma.
constexpr double kLogSigma = 1.5;
/// Of a prior over a number that may have either sign, in its typical size.
constexpr double kLinearSigma = 1.5;
/// A uniform angle has this standard deviation.
constexpr double kAngleSigma = std::numbers::pi / 1.7320508075688772;

}  // namespace

std::string name_of(const Effects& effects) {
  std::string name;
  for (const sim::EffectInfo* effect : effects) {
    name += (name.empty() ? "" : "+") + std::string(effect->name);
  }
  return name.empty() ? "none" : name;
}

Layout::Layout(const RigModel& model, Effects effects)
    : model_(&model),
      effects_(std::move(effects)),
      setup_count_(static_cast<int>(model.doubtful().size())) {
  for (const sim::EffectInfo* effect : effects_) {
    for (const sim::EffectParameter& parameter : effect->parameters) {
      coordinates_.push_back({&parameter, model.unit_of(parameter)});
    }
  }
}

double Layout::setup_value(int i, double x) const {
  const DoubtfulValue& doubt = model_->doubtful()[i];
  return std::clamp(doubt.value + x * doubt.sigma, doubt.low, doubt.high);
}

double Layout::effect_value(int i, double x) const {
  const Coordinate& c = coordinates_[i];
  const sim::EffectParameter& p = *c.parameter;
  if (p.cyclic) return std::remainder(x, 2 * std::numbers::pi);
  const double value = p.logarithmic ? std::exp(std::clamp(x, -80.0, 80.0)) * c.unit : x * c.unit;
  return std::clamp(value, p.low, p.high);
}

double Layout::coordinate(int i, double value) const {
  const Coordinate& c = coordinates_[i];
  return c.parameter->logarithmic ? std::log(value / c.unit) : value / c.unit;
}

std::vector<double> Layout::setup(const Eigen::VectorXd& x) const {
  std::vector<double> values;
  for (int i = 0; i < setup_count_; ++i) values.push_back(setup_value(i, x[i]));
  return values;
}

std::vector<ActiveEffect> Layout::active(const Eigen::VectorXd& x) const {
  std::vector<ActiveEffect> active;
  int i = 0;
  for (const sim::EffectInfo* effect : effects_) {
    ActiveEffect one{effect, {}};
    for (std::size_t k = 0; k < effect->parameters.size(); ++k, ++i) {
      one.values.push_back(effect_value(i, x[setup_count_ + i]));
    }
    active.push_back(std::move(one));
  }
  return active;
}

double Layout::prior_mean(int i) const {
  if (i < setup_count_) return 0;
  const sim::EffectParameter& p = *coordinates_[i - setup_count_].parameter;
  return p.logarithmic ? std::log(p.typical) : 0;
}

double Layout::prior_sigma(int i) const {
  if (i < setup_count_) return 1;
  const sim::EffectParameter& p = *coordinates_[i - setup_count_].parameter;
  if (p.cyclic) return kAngleSigma;
  return p.logarithmic ? kLogSigma : kLinearSigma * p.typical;
}

Eigen::VectorXd Layout::stated() const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  for (int i = setup_count_; i < size(); ++i) {
    const sim::EffectParameter& p = *coordinates_[i - setup_count_].parameter;
    x[i] = p.logarithmic ? std::log(p.typical) : p.cyclic ? 0 : p.typical;
  }
  return x;
}

std::vector<Layout::Start> Layout::starts(const Eigen::VectorXd& setup_x) const {
  Start first{stated(), -1, -1};
  first.x.head(setup_count_) = setup_x.head(setup_count_);
  std::vector<Start> starts = {first};
  for (int i = setup_count_; i < size(); ++i) {
    const sim::EffectParameter& p = *coordinates_[i - setup_count_].parameter;
    // The first parameter is the size where it may be zero, or of either sign.
    const bool size = i == setup_count_ && (p.low == 0 || p.low < 0);
    std::vector<Start> next;
    for (const Start& start : starts) {
      const std::vector<double> at = p.starts.empty() ? std::vector<double>{p.typical} : p.starts;
      for (const double value : at) {
        next.push_back(start);
        next.back().x[i] = p.logarithmic ? std::log(value) : value;
        if (size) next.back().size_coordinate = i;
        if (p.cyclic) next.back().phase_coordinate = i;
      }
    }
    starts = std::move(next);
  }
  return starts;
}

}  // namespace hoof::tools
