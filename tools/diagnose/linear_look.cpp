#include "tools/diagnose/linear_look.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools {
namespace {

/// A start is scaled to the size the recordings ask for, by no more than this.
constexpr double kMostScale = 30;
/// A step that is no larger than this changes nothing.
constexpr double kNothing = 1e-12;

Effects with(const Effects& effects, const sim::EffectInfo* one) {
  Effects sum = effects;
  sum.push_back(one);
  return sum;
}

/// A factor that does nothing at 1, searched by its logarithm, which is the effect's size then;
/// -1: there is none.
int ratio_of(const sim::EffectInfo& effect) {
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const sim::EffectParameter& p = effect.parameters[i];
    if (p.logarithmic && p.unit == "1" && p.low < 1 && p.high > 1) return static_cast<int>(i);
  }
  return -1;
}

/// A pair in the order of its names.
void put_in_order(const Layout& nominal, Fit& fit) {
  if (fit.effects.size() != 2 || fit.effects[0]->name < fit.effects[1]->name) return;
  const Eigen::Index setup = nominal.size();
  const auto first = static_cast<Eigen::Index>(fit.effects[0]->parameters.size());
  const Eigen::Index second = fit.x.size() - setup - first;
  Eigen::VectorXd x(fit.x.size());
  x << fit.x.head(setup), fit.x.tail(second), fit.x.segment(setup, first);
  fit.x = x;
  std::swap(fit.effects[0], fit.effects[1]);
}

}  // namespace

std::vector<LinearStart> starts_of(const RigModel& model, const sim::EffectInfo* effect) {
  const Layout alone(model, {effect});
  const int setup = alone.setup_count();
  std::vector<LinearStart> starts;
  for (const Layout::Start& s : alone.starts(alone.stated())) {
    LinearStart start{effect, s.x.tail(alone.size() - setup)};
    if (s.size_coordinate >= 0) {
      start.size = s.size_coordinate - setup;
      start.by_log = alone.of_effect(start.size).parameter->logarithmic;
    }
    if (start.size < 0) {
      // About 1 all starts of a ratio are one: those above it stand for all.
      start.size = ratio_of(*effect);
      if (start.size >= 0 && start.own[start.size] <= 0) continue;
    }
    if (s.phase_coordinate >= 0) start.phase = s.phase_coordinate - setup;
    starts.push_back(std::move(start));
  }
  return starts;
}

LinearBase::LinearBase(const Fitter& fitter, Fit base, Fitter::Weights weights)
    : fitter_(fitter), base_(std::move(base)), weights_(std::move(weights)) {
  const Layout layout(fitter.model(), base_.effects);
  const Eigen::VectorXd r = fitter.residuals(layout, base_.x, weights_);
  J_ = fitter.jacobian(layout, base_.x, r, weights_);
  r_ = r.head(r.size() - layout.size());
  prior_ = r.tail(layout.size());
}

/// Least squares over the effect's share s and the base's coordinates d:
///   r + s (r1 - r) + J d, r1 the residuals with the effect as it starts, s = 1 where it has no
/// size. Priors of the base's coordinates are rows of J.
LinearStep LinearBase::beside(const LinearStart& start) const {
  LinearStep step{with(base_.effects, start.effect), {}, {}, -1, start.by_log, 0};
  const Layout layout(fitter_.model(), step.effects);
  const Eigen::Index own = start.own.size(), before = base_.x.size();
  step.from.resize(before + own);
  step.from << base_.x, start.own;
  step.change = Eigen::VectorXd::Zero(before + own);
  if (start.size >= 0) step.size_coordinate = static_cast<int>(before) + start.size;
  const Eigen::VectorXd c = fitter_.residuals(layout, step.from, weights_).head(r_.size()) - r_;
  if (!(c.squaredNorm() > kNothing)) return step;

  Eigen::VectorXd r(J_.rows()), effect = Eigen::VectorXd::Zero(J_.rows());
  r << r_, prior_;
  effect.head(r_.size()) = c;
  const bool sized = step.size_coordinate >= 0;
  Eigen::MatrixXd A(J_.rows(), before + (sized ? 1 : 0));
  A.leftCols(before) = J_;
  if (sized) A.col(before) = effect;
  const Eigen::VectorXd target = sized ? Eigen::VectorXd(-r) : Eigen::VectorXd(-r - effect);
  if (A.cols() == 0) {
    step.gain = 0.5 * (r.squaredNorm() - target.squaredNorm());
    return step;
  }
  const Eigen::VectorXd solved = A.colPivHouseholderQr().solve(target);
  step.change.head(before) = solved.head(before);
  step.gain = 0.5 * (r.squaredNorm() - (A * solved - target).squaredNorm());
  if (!sized) return step;
  double share = solved[before];
  if (share < 0 && start.phase >= 0) {
    step.from[before + start.phase] += std::numbers::pi;
    share = -share;
  }
  if (start.by_log && share <= 0) {
    step.gain = 0;
    return step;
  }
  share = std::clamp(share, start.by_log ? 1 / kMostScale : -kMostScale, kMostScale);
  double& size = step.from[step.size_coordinate];
  size = start.by_log ? size + std::log(share) : size * share;
  const auto& bounded = layout.of_effect(step.size_coordinate - layout.setup_count());
  if (bounded.parameter->logarithmic) {
    // Beyond a bound nothing changes any more, and a fit would stay there.
    size = std::clamp(size, std::log(std::max(bounded.parameter->low, 1e-300) / bounded.unit),
                      std::log(bounded.parameter->high / bounded.unit));
  }
  return step;
}

Eigen::VectorXd LinearBase::at(const LinearStep& step, double share) const {
  Eigen::VectorXd x = step.from + share * step.change;
  if (step.size_coordinate >= 0) {
    double& size = x[step.size_coordinate];
    size = step.by_log ? size + std::log(share) : size * share;
  }
  return x;
}

Fit LinearBase::least_along(const LinearStep& step) const {
  Fit fit;
  fit.effects = step.effects;
  double least = 1e300;
  for (const double share : {1.0, 0.4, 0.1, 0.01}) {
    const Eigen::VectorXd x = at(step, share);
    const double objective = fitter_.objective(step.effects, x, weights_);
    if (objective < least) least = objective, fit.x = x;
  }
  put_in_order(Layout(fitter_.model(), {}), fit);
  return fit;
}

}  // namespace hoof::tools
