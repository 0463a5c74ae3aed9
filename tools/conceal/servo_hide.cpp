#include "tools/conceal/servo_hide.h"

#include <algorithm>
#include <cmath>

namespace hoof::tools::conceal {
namespace {

/// What is hidden must stand out by this many deviations over the whole data set, after the
/// nominal parameters have done all they can: less nobody could be blamed for missing.
constexpr double kLeastStrength = 15.0, kLeastStrengthUnknown = 25.0, kLeastStrengthAlike = 9.0;
constexpr double kLargestShare = 0.5;

/// A position loop that the effect makes ring shows the ringing and little else.
bool rings(const ServoPlan& plan, const std::vector<ServoSignals>& with, const ServoScale& clean) {
  return plan.machine.law != DriveLaw::kTorque &&
         scale_of(plan, with).velocity_rms > 2.0 * clean.velocity_rms;
}

/// The thermal effect's numbers are of the contract's scale: the rms current over the data is 1.
void normalise_heat(HiddenInServo& hidden) {
  for (HiddenEffect& effect : hidden.effects) {
    if (effect.name != "thermal_derating") continue;
    double square = 0.0, fourth = 0.0, heat = 0.0, count = 0.0;
    for (const ServoSignals& s : hidden.signals) {
      const double n = double(s.position.size());
      square += s.square_current_mean * n;
      fourth += s.fourth_current_mean * n;
      heat += s.square_heat_mean * n;
      count += n;
    }
    const double reference = effect.at("_reference");
    const double per_A2 = effect.at("fraction") / (reference * reference);
    effect.find("_reference").value = std::sqrt(square / count);
    effect.find("fraction").value = per_A2 * square / count;
    effect.find("fraction").other_readings = {per_A2 * std::sqrt(fourth / count),
                                              per_A2 * std::sqrt(heat / count)};
  }
}

SeenChange change_without(const ServoPlan& plan, const HiddenInServo& hidden,
                          const Eigen::VectorXd& with, std::size_t index) {
  std::vector<HiddenEffect> others = hidden.effects;
  others.erase(others.begin() + std::ptrdiff_t(index));
  const Eigen::VectorXd without = whitened(plan, run_plan(plan, others));
  return seen_change(plan, with - without, sensitivities(plan, hidden.effects, others, with));
}

}  // namespace

bool all_sane(const std::vector<ServoSignals>& signals) {
  return std::all_of(signals.begin(), signals.end(), [](const auto& s) { return s.sane; });
}

bool hide_in_servo(const CaseRequest& request, const ServoPlan& plan, const ServoScale& scale,
                   const RandomStream& random, HiddenInServo& hidden,
                   const std::function<void(HiddenEffect&)>& adapt) {
  const double least = request.kind == "unknown"         ? kLeastStrengthUnknown
                       : request.kind == "not_decidable" ? kLeastStrengthAlike
                                                         : kLeastStrength;
  std::vector<double> shares;
  RandomStream sizes = random.branch(0);
  for (std::size_t i = 0; i < request.effects.size(); ++i) {
    shares.push_back(sizes.log_uniform(0.05, 0.4));
  }
  for (int growth = 0; growth < 5; ++growth) {
    hidden = {};
    for (std::size_t i = 0; i < request.effects.size(); ++i) {
      RandomStream draw = random.branch(i + 1);
      hidden.effects.push_back(draw_servo_effect(request.effects[i], shares[i], plan, scale, draw));
    }
    if (adapt) {
      for (HiddenEffect& effect : hidden.effects) adapt(effect);
    }
    hidden.signals = run_plan(plan, hidden.effects);
    if (!all_sane(hidden.signals) || rings(plan, hidden.signals, scale)) return false;
    normalise_heat(hidden);
    const Eigen::VectorXd with = whitened(plan, hidden.signals);
    bool seen = true;
    for (std::size_t i = 0; i < hidden.effects.size(); ++i) {
      hidden.changes.push_back(change_without(plan, hidden, with, i));
      if (hidden.changes.back().strength >= least) continue;
      seen = false;
      if (shares[i] >= kLargestShare) return false;
      shares[i] = std::min(kLargestShare, 1.6 * shares[i]);
    }
    if (!seen) continue;
    const Eigen::VectorXd without = whitened(plan, run_plan(plan, {}));
    hidden.together =
        seen_change(plan, with - without, sensitivities(plan, hidden.effects, {}, with));
    return true;
  }
  return false;
}

}  // namespace hoof::tools::conceal
