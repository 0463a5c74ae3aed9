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

/// Alike but for a phase, which is a quarter of a turn on.
bool quarter_apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b, int phase) {
  Eigen::VectorXd difference = b - a;
  difference[phase] -= std::numbers::pi / 2;
  return difference.norm() < 1e-9;
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
  t.r = fitter.residuals(layout, fit.x, weights);
  if (layout.size() > 0) {
    const Eigen::MatrixXd J = fitter.jacobian(layout, fit.x, t.r, weights);
    t.inverse = (J.transpose() * J).ldlt().solve(J.transpose());
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(J);
    t.basis = qr.householderQ() * Eigen::MatrixXd::Identity(J.rows(), J.cols());
  }
  return t;
}

namespace {

/// One start of an effect beside a fit, and what it changes.
struct Look {
  Eigen::VectorXd x;
  Eigen::VectorXd change;  // of the base's residuals
  Eigen::VectorXd beyond;  // the part of it that the base's own coordinates cannot make
  int size = -1, phase = -1;
};

/// Both phases of an effect that repeats are one linear step: amplitude and phase follow. The first
/// look is to be at phase 0, the second a quarter of a turn on, all else the same.
Look turned(const Tangent& tangent, const Look& sine, const Look& cosine, bool by_log) {
  Eigen::Matrix2d normal;
  normal << sine.beyond.squaredNorm(), sine.beyond.dot(cosine.beyond),
      sine.beyond.dot(cosine.beyond), cosine.beyond.squaredNorm();
  const Eigen::Vector2d right(-sine.beyond.dot(tangent.r), -cosine.beyond.dot(tangent.r));
  const Eigen::Vector2d share = normal.ldlt().solve(right);
  const double size = share.norm();
  if (!std::isfinite(size) || !(size > 0)) return sine;
  Look look = sine;
  // As large as the start's own size, in the direction that is asked for.
  const Eigen::Vector2d unit = share / size;
  look.change = unit[0] * sine.change + unit[1] * cosine.change;
  look.beyond = unit[0] * sine.beyond + unit[1] * cosine.beyond;
  look.x[look.phase] = std::atan2(unit[1], unit[0]);
  if (!by_log) look.x[look.size] = std::abs(look.x[look.size]);
  return look;
}

}  // namespace

std::vector<SearchStart> starts_beside(const Fitter& fitter, const Fit& base,
                                       const Tangent& tangent, const sim::EffectInfo* effect,
                                       const Fitter::Weights& weights) {
  const Layout alone(fitter.model(), {effect});
  const Layout both(fitter.model(), with(base.effects, effect));
  const int setup = alone.setup_count();
  const int shift = both.size() - alone.size();
  std::vector<Look> looks;
  for (const Layout::Start& start : alone.starts(base.x)) {
    Look look;
    look.x.resize(both.size());
    look.x << base.x, start.x.tail(alone.size() - setup);
    look.size = start.size_coordinate < 0 ? -1 : start.size_coordinate + shift;
    look.phase = start.phase_coordinate < 0 ? -1 : start.phase_coordinate + shift;
    // Samples, and priors of the base's own coordinates; its effect's own stay out of it.
    Eigen::VectorXd r = tangent.r;
    const Eigen::VectorXd there = fitter.residuals(both, look.x, weights);
    const Eigen::Index samples = there.size() - both.size();
    r.head(samples) = there.head(samples);
    look.change = r - tangent.r;
    look.beyond = perpendicular(tangent, look.change);
    const bool by_log = look.size >= 0 && both.of_effect(look.size - setup).parameter->logarithmic;
    const bool second = look.size >= 0 && look.phase >= 0 && !looks.empty() &&
                        quarter_apart(looks.back().x, look.x, look.phase);
    if (second) {
      looks.back() = turned(tangent, looks.back(), look, by_log);
    } else {
      looks.push_back(std::move(look));
    }
  }
  std::vector<SearchStart> candidates;
  for (Look& look : looks) {
    Eigen::VectorXd give = Eigen::VectorXd::Zero(look.x.size());
    if (tangent.inverse.size() > 0) {
      give.head(base.x.size()) = -tangent.inverse * look.change;
    }
    const double square = look.beyond.squaredNorm();
    if (!(square > 1e-12)) continue;
    double scale = -tangent.r.dot(look.beyond) / square;
    if (scale < 0 && look.phase >= 0) {
      look.x[look.phase] += std::numbers::pi;
      scale = -scale;
      give = -give;
    }
    double gain = 0.5 * scale * scale * square;
    bool by_log = false;
    if (look.size >= 0) {
      by_log = both.of_effect(look.size - setup).parameter->logarithmic;
      if (by_log && scale <= 0) continue;
      const double limited = std::clamp(scale, by_log ? 1 / kMostScale : -kMostScale, kMostScale);
      give *= limited;
      if (by_log) {
        look.x[look.size] += std::log(limited);
      } else {
        look.x[look.size] *= limited;
      }
    } else {
      // No size to scale: what the start itself gains, the base's own coordinates giving way.
      gain = 0.5 * (perpendicular(tangent, tangent.r).squaredNorm() -
                    (perpendicular(tangent, tangent.r) + look.beyond).squaredNorm());
    }
    candidates.push_back({both.effects(), look.x, give, gain, look.size, by_log});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const SearchStart& a, const SearchStart& b) { return a.gain > b.gain; });
  return candidates;
}

}  // namespace hoof::tools
