#include "tools/diagnose/effects_file.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/config/settings.h"
#include "tools/diagnose/toml_view.h"
#include "tools/report/display_unit.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

constexpr int kFormat = 1;
constexpr int kDigits = 4;  // of what stands in comments

using Words = std::vector<std::string>;

Words effect_names() {
  Words names;
  for (const sim::EffectInfo& info : sim::effect_catalogue()) names.emplace_back(info.name);
  return names;
}

ActiveEffect read_effect(const TomlView& effects, const std::string& name) {
  ActiveEffect effect{sim::find_effect(name), {}};
  const TomlView table = effects.table(name);
  Words known;
  for (const sim::EffectParameter& p : effect.info->parameters) known.emplace_back(p.name);
  const std::string joint = "joint";
  if (effect.info->make_joint) known.push_back(joint);
  table.allow_only(known, "parameter of " + name);
  if (table.has(joint)) effect.joint = table.choice(joint, Words{"toe", "hip", "knee"});
  for (const sim::EffectParameter& p : effect.info->parameters) {
    const std::string key(p.name);
    const double value = table.number(key, Allowed::kAny);
    if (value < p.low || value > p.high) {
      const std::string unit = p.unit == "1" ? "" : " " + std::string(p.unit);
      table.fail(key,
                 "must be from " + format_number(p.low) + " to " + format_number(p.high) + unit);
    }
    effect.values.push_back(value);
  }
  return effect;
}

/// A key as TOML takes it, in quotes where it is not of letters, digits, _ and -.
std::string toml_key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
  if (bare) return key;
  std::string quoted = "\"";
  for (const char c : key) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string line(const std::string& key, double value, const std::string& comment) {
  return toml_key(key) + " = " + sim::to_text(value) + "  # " + comment + "\n";
}

std::string comment_of(const ParameterEstimate& p) {
  std::string text = p.unit == "1" ? "" : p.unit + ", ";
  return text + "95 %: " + format_significant(p.low95, kDigits) + " to " +
         format_significant(p.high95, kDigits);
}

}  // namespace

EffectsFile read_effects_file(const std::filesystem::path& path) {
  const toml::table parsed = parse_toml_file(path);
  const TomlView root(parsed, path.string(), "");
  root.allow_only(Words{"format", "setup", "effects"});
  root.require("format", kFormat);
  EffectsFile file;
  if (root.has("setup")) {
    const TomlView setup = root.table("setup");
    for (const std::string& key : setup.keys()) file.setup[key] = setup.number(key, Allowed::kAny);
  }
  if (root.has("effects")) {
    const TomlView effects = root.table("effects");
    effects.allow_only(effect_names(), "effect");
    for (const std::string& name : effects.keys()) {
      file.effects.push_back(read_effect(effects, name));
    }
  }
  return file;
}

std::string effects_file_text(const Verdict& verdict, const std::vector<std::string>& data_sets) {
  std::string text = "# The model that hoof diagnose found for";
  for (std::size_t i = 0; i < data_sets.size(); ++i) {
    text += (i > 0 ? ", " : " ") + data_sets[i];
  }
  // A name may hold anything; a comment may not hold a line break.
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  text += ".\n# SI units. For hoof simulate --effects and for the simulator.\nformat = " +
          std::to_string(kFormat) + "\n";
  if (!verdict.setup.empty()) {
    text += "\n# Refitted; all other values of the setup stand in the data set.\n[setup]\n";
    for (const SetupEstimate& s : verdict.setup) {
      text += line(s.name, s.after,
                   (s.guessed ? "guessed " : "stated ") + format_number(s.stated) + ", sigma " +
                       format_number(s.sigma));
    }
  }
  for (const std::string& name : verdict.named) {
    const auto found =
        std::find_if(verdict.effects.begin(), verdict.effects.end(),
                     [&name](const EffectFinding& effect) { return effect.name == name; });
    if (found == verdict.effects.end()) {
      throw std::logic_error("the verdict names " + name + " but has no finding of it");
    }
    text += "\n";
    if (const sim::EffectInfo* info = sim::find_effect(name)) {
      text += "# " + std::string(info->summary) + "\n# " + std::string(info->equation) + "\n";
    }
    text += "[effects." + toml_key(name) + "]\n";
    for (const ParameterEstimate& p : found->parameters) {
      text += line(p.name, p.value, comment_of(p));
    }
    if (!found->joint.empty()) text += "joint = \"" + found->joint + "\"\n";
  }
  return text;
}

}  // namespace hoof::tools
