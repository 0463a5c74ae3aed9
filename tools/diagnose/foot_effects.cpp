#include "tools/diagnose/foot_effects.h"

#include <algorithm>
#include <array>

namespace hoof::tools {
namespace {

constexpr std::array kJoints = {sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee};

/// Where searches start on drives of this size: geared as a leg's are, not a toy servo's, and
/// commanded every millisecond.
void fit_to_drive(sim::EffectInfo& info, const sim::DriveSettings& drive) {
  const auto start = [&info](std::size_t i, double typical, std::vector<double> starts) {
    info.parameters[i].typical = typical;
    info.parameters[i].starts = std::move(starts);
  };
  const double k = drive.gear_stiffness_Nm_rad;
  if (info.name == "backlash") start(0, 0.01, {0.003, 0.01, 0.03});
  if (info.name == "joint_compliance") start(0, 0.1 * k, {0.02 * k, 0.1 * k, 0.4 * k});
  if (info.name == "actuator_lag") start(0, 0.005, {0.002, 0.006, 0.02});
  if (info.name == "transport_delay") start(0, 0.003, {0.001, 0.003, 0.009});
  // A gait or an opening turns a joint by less than a radian: low orders are slopes of it.
  if (info.name == "cogging_torque") start(1, 20, {6, 12, 20, 32, 48, 64});
}

/// Effects that a session of seconds cannot show, stand-ins that are much like another's.
bool left_out(const sim::EffectInfo& info) {
  if (info.name == "thermal_derating") return true;
  return !info.listed && info.name != "unlisted_torque_bias" &&
         info.name != "unlisted_quadratic_drag" && info.name != "unlisted_position_friction";
}

/// Replaces every name@joint by name.
std::string without_joints(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '@') {
      while (i + 1 < text.size() && std::isalpha(static_cast<unsigned char>(text[i + 1])) != 0) ++i;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

}  // namespace

std::string plain_effect_name(std::string_view name) {
  return std::string(name.substr(0, name.find('@')));
}

std::string joint_of_effect(std::string_view name) {
  const std::size_t at = name.find('@');
  return at == std::string_view::npos ? "" : std::string(name.substr(at + 1));
}

void FootEffects::add(const sim::EffectInfo& info, std::optional<sim::Joint> joint,
                      const RunSettings& run, double torque_unit_Nm) {
  std::vector<double> values;
  for (const sim::EffectParameter& p : info.parameters) values.push_back(p.typical);
  // Values only have to be possible here; torques among them are in another unit.
  if (!misfit(run, {&info, values, joint}).empty()) return;
  const std::string name =
      std::string(info.name) + (joint ? std::string("@") + sim::joint_name(*joint) : "");
  for (const Hypothesis& known : hypotheses_) {
    if (known.name == name) return;
  }
  Hypothesis& made = hypotheses_.emplace_back(Hypothesis{info, name, joint, torque_unit_Nm});
  if (joint) fit_to_drive(made.info, *run.drives[std::size_t(*joint)]);
  made.info.name = made.name;
  list_.push_back(&made.info);
}

void FootEffects::add_all(const RunSettings& run,
                          const std::array<double, sim::kJointCount>& torque_rms_Nm) {
  for (const sim::EffectInfo& info : sim::effect_catalogue()) {
    if (left_out(info)) continue;
    if (info.make_soil) add(info, {}, run, 1);
    if (!info.make_joint) continue;
    for (const sim::Joint joint : kJoints) {
      if (run.drives[std::size_t(joint)]) add(info, joint, run, torque_rms_Nm[std::size_t(joint)]);
    }
  }
}

std::optional<sim::Joint> FootEffects::joint(const ActiveEffect& effect) const {
  for (const Hypothesis& known : hypotheses_) {
    if (&known.info == effect.info) return known.joint;
  }
  for (const sim::Joint joint : kJoints) {
    if (effect.joint == sim::joint_name(joint)) return joint;
  }
  return {};
}

double FootEffects::unit_of(const sim::EffectParameter& parameter) const {
  // A spring of the gear is in its own unit already, by fit_to_drive().
  if (!parameter.unit.starts_with("Nm") || parameter.unit == "Nm/rad") return 1;
  for (const Hypothesis& known : hypotheses_) {
    for (const sim::EffectParameter& own : known.info.parameters) {
      if (&own == &parameter && known.torque_unit_Nm > 0) return known.torque_unit_Nm;
    }
  }
  return 1;
}

void name_joints(Verdict& verdict) {
  std::map<std::string, double> probabilities;
  for (const auto& [name, p] : verdict.probabilities) probabilities[plain_effect_name(name)] += p;
  verdict.probabilities = std::move(probabilities);
  // Most probable first: of each name the first is the one to tell; the others' shares are added.
  std::vector<EffectFinding> effects;
  for (EffectFinding& finding : verdict.effects) {
    finding.joint = joint_of_effect(finding.name);
    finding.name = plain_effect_name(finding.name);
    const auto same = std::find_if(effects.begin(), effects.end(), [&finding](const auto& other) {
      return other.name == finding.name;
    });
    if (same == effects.end()) {
      effects.push_back(std::move(finding));
    } else {
      same->probability = std::min(1.0, same->probability + finding.probability);
    }
  }
  std::stable_sort(
      effects.begin(), effects.end(),
      [](const EffectFinding& a, const EffectFinding& b) { return a.probability > b.probability; });
  verdict.effects = std::move(effects);
  std::vector<std::string> named;
  for (const std::string& name : verdict.named) {
    const std::string one = plain_effect_name(name);
    if (std::find(named.begin(), named.end(), one) == named.end()) named.push_back(one);
  }
  verdict.named = std::move(named);
  for (auto& set : verdict.not_separable) {
    std::vector<std::string> plain;
    for (const std::string& name : set) {
      const std::string one = plain_effect_name(name);
      if (std::find(plain.begin(), plain.end(), one) == plain.end()) plain.push_back(one);
    }
    set = plain;
  }
  for (AblationRow& row : verdict.ablation) row.model = without_joints(row.model);
}

}  // namespace hoof::tools
