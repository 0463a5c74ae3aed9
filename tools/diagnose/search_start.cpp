#include "tools/diagnose/search_start.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hoof::tools {
namespace {

/// A start is scaled to the size the recordings ask for, by no more than this.
constexpr double kMostScale = 30;

Eigen::VectorXd perpendicular(const Tangent& tangent, const Eigen::VectorXd& r) {
  if (tangent.basis.cols() == 0) return r;
  return r - tangent.basis * (tangent.basis.transpose() * r);
}

Effects with(const Effects& effects, const sim::EffectInfo* one) {
  Effects sum = effects;
  sum.push_back(one);
  return sum;
}

}  // namespace

Eigen::VectorXd carried(const RigModel& model, const Fit& from, const Effects& to,
                        Eigen::VectorXd x) {
  const int setup = Layout(model, {}).setup_count();
  x.head(setup) = from.x.head(setup);
  int at = setup;
  for (const sim::EffectInfo* effect : to) {
    const auto count = static_cast<int>(effect->parameters.size());
    int there = setup;
    for (const sim::EffectInfo* other : from.effects) {
      if (other == effect) x.segment(at, count) = from.x.segment(there, count);
      there += static_cast<int>(other->parameters.size());
    }
    at += count;
  }
  return x;
}

bool part_of(const Effects& some, const Effects& all) {
  return std::all_of(some.begin(), some.end(), [&all](const sim::EffectInfo* e) {
    return std::find(all.begin(), all.end(), e) != all.end();
  });
}

bool listed(const Effects& effects) {
  return std::all_of(effects.begin(), effects.end(),
                     [](const sim::EffectInfo* e) { return e->listed; });
}

Tangent tangent(const Fitter& fitter, const Fit& fit, const Fitter::Weights& weights) {
  const Layout layout(fitter.model(), fit.effects);
  Tangent t;
  const Eigen::VectorXd r = fitter.residuals(layout, fit.x, weights);
  const Eigen::Index samples = r.size() - layout.size();
  const Eigen::MatrixXd whole = fitter.jacobian(layout, fit.x, r, weights);
  const Eigen::MatrixXd J = whole.topRows(samples);
  t.r = r.head(samples);
  if (layout.size() > 0) {
    t.inverse = (whole.transpose() * whole).ldlt().solve(J.transpose());
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J);
    t.basis = qr.householderQ() * Eigen::MatrixXd::Identity(samples, J.cols());
  }
  return t;
}

std::vector<SearchStart> starts_beside(const Fitter& fitter, const Fit& base,
                                       const Tangent& tangent, const sim::EffectInfo* effect,
                                       const Fitter::Weights& weights) {
  const Layout alone(fitter.model(), {effect});
  const Layout both(fitter.model(), with(base.effects, effect));
  std::vector<SearchStart> candidates;
  for (const Layout::Start& start : alone.starts(base.x)) {
    const int setup = alone.setup_count();
    const auto own = alone.size() - setup;
    Eigen::VectorXd x(both.size());
    x << base.x, start.x.tail(own);
    const int shift = both.size() - alone.size();
    const Eigen::VectorXd r = fitter.residuals(both, x, weights).head(tangent.r.size());
    Eigen::VectorXd give = Eigen::VectorXd::Zero(x.size());
    if (tangent.inverse.size() > 0) {
      give.head(base.x.size()) = -tangent.inverse * (r - tangent.r);
    }
    const Eigen::VectorXd change = perpendicular(tangent, r - tangent.r);
    const double square = change.squaredNorm();
    if (!(square > 1e-12)) continue;
    double scale = -tangent.r.dot(change) / square;
    const int size = start.size_coordinate, phase = start.phase_coordinate;
    if (scale < 0 && phase >= 0) {
      x[phase + shift] += std::numbers::pi;
      scale = -scale;
      give = -give;
    }
    double gain = 0.5 * scale * scale * square;
    bool by_log = false;
    if (size >= 0) {
      by_log = alone.of_effect(size - setup).parameter->logarithmic;
      if (by_log && scale <= 0) continue;
      const double limited = std::clamp(scale, by_log ? 1 / kMostScale : -kMostScale, kMostScale);
      give *= limited;
      if (by_log) {
        x[size + shift] += std::log(limited);
      } else {
        x[size + shift] *= limited;
      }
    } else {
      // No size to scale: what the start itself gains, the base's own parameters refitted linearly.
      gain = 0.5 * (perpendicular(tangent, tangent.r).squaredNorm() -
                    perpendicular(tangent, r).squaredNorm());
    }
    candidates.push_back({both.effects(), x, give, gain, size >= 0 ? size + shift : -1, by_log});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const SearchStart& a, const SearchStart& b) { return a.gain > b.gain; });
  return candidates;
}

}  // namespace hoof::tools
