#include "tools/experiment/run_effects.h"

#include <algorithm>
#include <string_view>

#include "sim/config/config_error.h"
#include "sim/config/suggestion.h"
#include "tools/experiment/run_settings.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr std::string_view kEffects = "effects.";
constexpr std::string_view kSetup = "setup.";
constexpr std::string_view kJointKey = "joint";
constexpr std::int64_t kFormat = 1;
constexpr std::array kJoints = {sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee};

[[noreturn]] void fail(const sim::Entry& entry, const std::string& key, const std::string& rule) {
  throw sim::ConfigError(entry.origin.text() + ": " + key + " = " + sim::to_text(entry.value) +
                         ": " + rule);
}

std::string with_suggestion(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = sim::suggest(name, known);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

double number_of(const sim::Entry& entry, const std::string& key, double low, double high,
                 std::string_view unit) {
  const std::string rule = "must be a number from " + format_number(low) + " to " +
                           format_number(high) +
                           (unit.empty() || unit == "1" ? "" : " " + std::string(unit));
  double value = 0;
  if (const auto* d = std::get_if<double>(&entry.value)) {
    value = *d;
  } else if (const auto* i = std::get_if<std::int64_t>(&entry.value)) {
    value = double(*i);
  } else {
    fail(entry, key, rule);
  }
  if (!(value >= low && value <= high)) fail(entry, key, rule);
  return value;
}

/// "effects.NAME.KEY" in its parts.
struct EffectKey {
  std::string name, key;
};

EffectKey split(const std::string& full, const sim::Entry& entry) {
  const std::string rest = full.substr(kEffects.size());
  const std::size_t dot = rest.find('.');
  if (dot == std::string::npos) {
    fail(entry, full, "an effect is a table, [effects." + rest + "], of its parameters");
  }
  return {rest.substr(0, dot), rest.substr(dot + 1)};
}

const sim::EffectInfo& known_effect(const std::string& name, const std::string& key,
                                    const sim::Entry& entry) {
  if (const sim::EffectInfo* info = sim::find_effect(name)) return *info;
  std::vector<std::string> names;
  for (const sim::EffectInfo& info : sim::effect_catalogue()) {
    if (info.listed) names.emplace_back(info.name);
  }
  fail(entry, key, "no effect of this name" + with_suggestion(name, names));
}

sim::Joint read_joint(const sim::Entry& entry, const std::string& key) {
  if (const auto* text = std::get_if<std::string>(&entry.value)) {
    for (const sim::Joint joint : kJoints) {
      if (*text == sim::joint_name(joint)) return joint;
    }
  }
  fail(entry, key, "must be \"toe\", \"hip\" or \"knee\"");
}

/// All parameters, and nothing else but a joint.
RunEffect read_effect(const sim::Settings& tree, const sim::EffectInfo& info,
                      const std::string& first_key, const sim::Entry& first) {
  const std::string prefix = std::string(kEffects) + std::string(info.name) + ".";
  RunEffect effect{&info, {}, {}};
  std::vector<std::string> known;
  for (const sim::EffectParameter& p : info.parameters) {
    known.emplace_back(p.name);
    const sim::Entry* entry = tree.find(prefix + known.back());
    if (entry == nullptr) {
      throw sim::ConfigError(first.origin.text() + ": " + first_key + ": " +
                             std::string(info.name) + " needs " + known.back() + ", too");
    }
    effect.values.push_back(number_of(*entry, prefix + known.back(), p.low, p.high, p.unit));
  }
  if (info.make_joint) known.emplace_back(kJointKey);
  for (const auto& [key, entry] : tree.entries()) {
    if (!key.starts_with(prefix)) continue;
    const std::string name = key.substr(prefix.size());
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fail(entry, key, "no such parameter" + with_suggestion(name, known));
    }
    if (name == kJointKey && info.make_joint) effect.joint = read_joint(entry, key);
  }
  return effect;
}

std::string joint_misfit(const RunSettings& run, const RunEffect& effect) {
  if (effect.info->make_joint(effect.values)->stages() & sim::kSupplyStage) {
    return "the drives of the foot have no supply voltage in their model";
  }
  const auto has = run.has_drives();
  if (effect.joint && !has[std::size_t(*effect.joint)]) {
    return std::string("this run has no drive at the ") + sim::joint_name(*effect.joint);
  }
  if (std::none_of(has.begin(), has.end(), [](bool there) { return there; })) {
    return "this run has no drives";
  }
  return "";
}

/// What presses of plates show and a foot on its facets has no place for.
std::string plate_only(std::string_view name) {
  if (name == "rig_compliance") return "the foot's depth is not measured through a rig that bends";
  if (name == "packing_change") return "a run is one press, which nothing goes before";
  if (name == "plate_size_law") return "a foot of facets has no one width";
  if (name == "unload_hysteresis") return "the fast soil unloads by a law of its own";
  return "";
}

std::string soil_misfit(const RunSettings& run, const RunEffect& effect) {
  if (effect.info->make_soil(effect.values)->spine_loss_m() > 0) {
    return run.foot.geometry.has_spines ? "" : "the foot '" + run.foot_name + "' has no spines";
  }
  if (effect.info->name == "spine_wear") return "";
  if (run.terrain == "dem") {
    return "grains follow the laws of their contacts, which know no such term; use terrain rft";
  }
  if (run.terrain == "rigid") return "a rigid floor is no soil; use terrain rft";
  if (!effect.info->listed) return "a stand-in for what has no name yet, made for plates";
  return plate_only(effect.info->name);
}

}  // namespace

const std::vector<SetupNumber>& setup_numbers() {
  static const std::vector<SetupNumber> numbers = {
      {"load", 0.1, 1e5},      {"soil_stiffness", 1e3, 1e10}, {"soil_yield", 1e-5, 0.1},
      {"soil_friction", 0, 5}, {"toe_coulomb", 0, 1e3},       {"toe_viscous", 0, 1e3},
      {"hip_coulomb", 0, 1e4}, {"hip_viscous", 0, 1e4},       {"knee_coulomb", 0, 1e4},
      {"knee_viscous", 0, 1e4}};
  return numbers;
}

double* find_setup_number(RunSettings& run, const std::string& name) {
  if (name == "load") return run.is_sinkage() ? &run.sinkage.load_N : nullptr;
  if (name.starts_with("soil_")) {
    if (run.terrain != "rft") return nullptr;
    if (name == "soil_stiffness") return &run.rft.xi_n_N_m3.value;
    if (name == "soil_yield") return &run.rft.yield_displacement_m.value;
    return name == "soil_friction" ? &run.rft.surface_friction : nullptr;
  }
  for (const sim::Joint joint : kJoints) {
    auto& drive = run.drives[std::size_t(joint)];
    if (!drive) continue;
    const std::string prefix = std::string(sim::joint_name(joint)) + "_";
    if (name == prefix + "coulomb") return &drive->coulomb_friction_Nm;
    if (name == prefix + "viscous") return &drive->viscous_friction_Nm_s_rad;
  }
  return nullptr;
}

void merge_effects(const std::string& file, sim::Settings& tree) {
  const sim::Settings effects = sim::Settings::load_file(file);
  const sim::Entry* format = effects.find("format");
  if (format == nullptr) throw sim::ConfigError(file + ": format: missing; must be 1");
  if (format->value != sim::Value(kFormat)) fail(*format, "format", "must be 1");
  for (const auto& [key, entry] : effects.entries()) {
    if (key == "format") continue;
    if (!key.starts_with(kEffects) && !key.starts_with(kSetup)) {
      fail(entry, key, "a file of effects has format, [setup] and [effects.NAME] only");
    }
  }
  tree.merge(effects);
  tree.erase("format");
}

void read_run_effects(RunSettings& run) {
  for (const auto& [key, entry] : run.tree.entries()) {
    if (!key.starts_with(kSetup)) continue;
    const std::string name = key.substr(kSetup.size());
    const auto& known = setup_numbers();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&name](const SetupNumber& n) { return n.name == name; });
    if (found == known.end()) {
      std::vector<std::string> names;
      for (const SetupNumber& number : known) names.push_back(number.name);
      fail(entry, key, "no such number of the foot's plant" + with_suggestion(name, names));
    }
    double* number = find_setup_number(run, name);
    if (number == nullptr) fail(entry, key, "this run has no such number");
    *number = number_of(entry, key, found->low, found->high, "");
    run.setup[name] = *number;
  }
  for (const auto& [key, entry] : run.tree.entries()) {
    if (!key.starts_with(kEffects)) continue;
    const std::string name = split(key, entry).name;
    const auto same = [&name](const RunEffect& e) { return e.info->name == name; };
    if (std::any_of(run.effects.begin(), run.effects.end(), same)) continue;
    run.effects.push_back(read_effect(run.tree, known_effect(name, key, entry), key, entry));
    const std::string why = misfit(run, run.effects.back());
    if (!why.empty()) {
      throw sim::ConfigError(entry.origin.text() + ": effects." + name + ": " + why);
    }
  }
}

std::string misfit(const RunSettings& run, const RunEffect& effect) {
  if (effect.info->make_joint) return joint_misfit(run, effect);
  if (effect.info->make_soil) return soil_misfit(run, effect);
  return "nothing that acts in a foot's plant";
}

sim::Foot foot_with_effects(const RunSettings& run) {
  double loss_m = 0;
  for (const RunEffect& effect : run.effects) {
    if (effect.info->make_soil) {
      loss_m += effect.info->make_soil(effect.values)->spine_loss_m();
    }
  }
  return loss_m > 0 ? sim::with_worn_spines(run.foot, loss_m) : run.foot;
}

void add_soil_effects(const RunSettings& run, sim::RftTerrain& terrain) {
  for (const RunEffect& effect : run.effects) {
    if (effect.info->make_soil) terrain.add_effect(effect.info->make_soil(effect.values));
  }
}

void add_joint_effects(const RunSettings& run, sim::Plant& plant) {
  for (const RunEffect& effect : run.effects) {
    if (!effect.info->make_joint) continue;
    for (const sim::Joint joint : kJoints) {
      sim::Drive* drive = plant.drive(joint);
      if (drive == nullptr || (effect.joint && *effect.joint != joint)) continue;
      drive->add_physics(effect.info->make_joint(effect.values));
    }
  }
}

std::vector<EffectText> effect_texts(const RunSettings& run) {
  std::vector<EffectText> texts;
  for (const RunEffect& effect : run.effects) {
    EffectText text{std::string(effect.info->name), ""};
    if (effect.info->make_joint) {
      text.name += effect.joint ? std::string(" at the ") + sim::joint_name(*effect.joint)
                                : std::string(" at all drives");
    }
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      const sim::EffectParameter& p = effect.info->parameters[i];
      text.values += (i > 0 ? ", " : "") + std::string(p.name) + " " +
                     format_number(effect.values[i]) +
                     (p.unit == "1" ? "" : " " + std::string(p.unit));
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

std::string effects_toml(const RunSettings& run, const std::string& head) {
  std::string text = "# " + head + "\n# SI units.\nformat = 1\n";
  if (!run.setup.empty()) text += "\n[setup]\n";
  for (const auto& [name, value] : run.setup) text += name + " = " + sim::to_text(value) + "\n";
  for (const RunEffect& effect : run.effects) {
    text += "\n[effects." + std::string(effect.info->name) + "]\n";
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      text += std::string(effect.info->parameters[i].name) + " = " +
              sim::to_text(effect.values[i]) + "\n";
    }
    if (effect.joint) {
      text += "joint = \"" + std::string(sim::joint_name(*effect.joint)) + "\"\n";
    }
  }
  return text;
}

}  // namespace hoof::tools
