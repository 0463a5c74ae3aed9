#include "tools/diagnose/next_experiment.h"

#include "tools/diagnose/foot_effects.h"

namespace hoof::tools {
namespace {

std::string experiment_of(const std::string& effect) {
  const sim::EffectInfo* info = sim::find_effect(plain_effect_name(effect));
  return info ? std::string(info->experiment) : "";
}

}  // namespace

std::string next_experiment(const Judgement& judgement, const Verdict& verdict) {
  std::string text;
  if (verdict.verdict == "not_separable") {
    for (const std::string& name : verdict.not_separable.front()) {
      const std::string one = experiment_of(name);
      if (!one.empty()) text += (text.empty() ? "" : "; and ") + one + " (shows " + name + ")";
    }
  } else if (verdict.verdict == "unknown_physics") {
    for (const Standing& s : judgement.standings) {
      if (s.listed || s.fit->effects.empty()) continue;
      text = std::string(s.fit->effects.front()->experiment);
      break;
    }
  }
  return text;
}

}  // namespace hoof::tools
