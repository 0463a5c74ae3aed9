#include "tools/diagnose/verdict_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/effects/effect.h"
#include "tools/report/display_unit.h"
#include "tools/run/column_unit.h"

namespace hoof::tools {
namespace {

constexpr int kDigits = 3;
constexpr std::size_t kShownIntervals = 3;
constexpr std::size_t kShownRivals = 4;
constexpr double kLeastShownProbability = 0.005;
constexpr std::size_t kShownSetup = 5;

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

double probability_of(const Verdict& verdict, const std::string& name) {
  const auto found = verdict.probabilities.find(name);
  return found == verdict.probabilities.end() ? 0 : found->second;
}

std::string named_text(const Verdict& verdict) {
  std::vector<std::string> words;
  for (const std::string& name : verdict.named) {
    const EffectFinding* finding = find_finding(verdict, name);
    const double probability =
        finding == nullptr ? probability_of(verdict, name) : finding->probability;
    words.push_back(name + " (probability " + probability_text(probability) + ")");
  }
  return joined(words, " and ");
}

std::string missing_text(const Verdict& verdict) {
  std::string text = "The model lacks " + named_text(verdict);
  if (verdict.named.size() == 1) {
    const sim::EffectInfo* info = sim::find_effect(verdict.named.front());
    if (info != nullptr) text += ": " + std::string(info->summary);
  }
  return text + ".";
}

std::string unknown_text(const Verdict& verdict) {
  std::string text = "The model lacks something that no known effect explains (probability " +
                     probability_text(probability_of(verdict, "unknown")) + ")";
  if (verdict.unknown_term && !verdict.unknown_term->inputs.empty()) {
    text += "; it goes with " + joined(verdict.unknown_term->inputs, ", ");
  }
  return text + ".";
}

std::string not_separable_text(const Verdict& verdict) {
  std::vector<std::string> sets;
  for (const auto& set : verdict.not_separable) {
    std::vector<std::string> members;
    for (const std::string& name : set) {
      const EffectFinding* finding = find_finding(verdict, name);
      const double p = finding == nullptr ? probability_of(verdict, name) : finding->probability;
      members.push_back(name + " (" + probability_text(p) + ")");
    }
    sets.push_back(joined(members, " or "));
  }
  return "These recordings cannot tell which it is: " + joined(sets, "; or which of ") + ".";
}

/// "none 0.02, backlash 0.01": what else there might be.
std::string rivals_text(const Verdict& verdict) {
  std::vector<std::pair<double, std::string>> rivals;
  for (const auto& [name, probability] : verdict.probabilities) {
    const bool named =
        std::find(verdict.named.begin(), verdict.named.end(), name) != verdict.named.end();
    if (!named && probability >= kLeastShownProbability) rivals.emplace_back(probability, name);
  }
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (rivals.size() > kShownRivals) rivals.resize(kShownRivals);
  std::vector<std::string> words;
  for (const auto& [probability, name] : rivals) {
    words.push_back(name + " " + probability_text(probability));
  }
  return words.empty() ? "none worth naming" : joined(words, ", ");
}

std::string parameters_text(const Verdict& verdict) {
  std::vector<std::string> words;
  for (const std::string& name : verdict.named) {
    const EffectFinding* finding = find_finding(verdict, name);
    if (finding == nullptr) continue;
    for (const ParameterEstimate& p : finding->parameters) {
      words.push_back((verdict.named.size() > 1 ? name + " " : "") + parameter_text(p));
    }
  }
  return words.empty() ? "none" : joined(words, "; ");
}

std::string setup_text(const Verdict& verdict) {
  if (verdict.setup.empty()) return "nothing was in doubt";
  std::vector<std::string> words;
  for (const SetupEstimate& s : verdict.setup) {
    words.push_back(s.name + " " + format_significant(s.after, kDigits) +
                    (s.guessed ? " (guessed " : " (stated ") +
                    format_significant(s.stated, kDigits) + ")");
  }
  const std::size_t more = words.size() > kShownSetup ? words.size() - kShownSetup : 0;
  words.resize(words.size() - more);
  return joined(words, ", ") + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

std::string quality_text(const Verdict& verdict) {
  if (verdict.quality.empty()) return "nothing to say against the data";
  const auto serious = std::count_if(verdict.quality.begin(), verdict.quality.end(),
                                     [](const QualityNote& note) { return note.serious; });
  std::string text =
      std::to_string(verdict.quality.size()) + " note(s), " + std::to_string(serious) + " serious";
  for (const QualityNote& note : verdict.quality) {
    if (!note.serious) continue;
    return text + ": " + (note.recording.empty() ? "" : note.recording + ": ") + note.text;
  }
  return text;
}

}  // namespace

std::string channel_unit(RigKind rig, const std::string& channel) {
  if (rig == RigKind::kFootHil) {
    const ColumnUnit* unit = find_column_unit(channel);
    return unit == nullptr ? "" : std::string(unit->symbol);
  }
  const bool turns = rig == RigKind::kServoPendulum;
  if (channel == "position" || channel == "position_goal") return turns ? "rad" : "m";
  if (channel == "velocity" || channel == "velocity_goal") return "rad/s";
  if (channel == "torque" || channel == "torque_ff") return "Nm";
  if (channel == "force") return "N";
  if (channel == "current") return "A";
  if (channel == "supply_voltage") return "V";
  if (channel == "temperature") return "degC";
  return "";
}

std::string channel_of_error(const std::string& key) {
  const std::string ending = "_rmse";
  return key.ends_with(ending) ? key.substr(0, key.size() - ending.size()) : key;
}

std::string probability_text(double probability) {
  constexpr double kHalfDigit = 0.005;
  if (probability > 1 - kHalfDigit) return "> 0.99";
  if (probability < kHalfDigit) return "< 0.01";
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", probability);
  return text;
}

std::string with_unit(double value, const std::string& unit) {
  const std::string number =
      std::isfinite(value) ? format_significant(value + 0.0, kDigits) : "diverged";  // no -0
  return unit.empty() || unit == "1" ? number : number + " " + unit;
}

const EffectFinding* find_finding(const Verdict& verdict, const std::string& name) {
  const auto found =
      std::find_if(verdict.effects.begin(), verdict.effects.end(),
                   [&name](const EffectFinding& effect) { return effect.name == name; });
  return found == verdict.effects.end() ? nullptr : &*found;
}

std::vector<std::string> effects_in_question(const Verdict& verdict) {
  std::vector<std::string> names = verdict.named;
  for (const auto& set : verdict.not_separable) {
    for (const std::string& name : set) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string headline(const Verdict& verdict) {
  if (verdict.verdict == "none") {
    return "The model explains these recordings; nothing is missing (probability " +
           probability_text(probability_of(verdict, "none")) + ").";
  }
  if (verdict.verdict == "unknown_physics") return unknown_text(verdict);
  if (verdict.verdict == "not_separable") return not_separable_text(verdict);
  return missing_text(verdict);
}

std::string parameter_text(const ParameterEstimate& p) {
  const auto bound = [](double value) {
    return std::isfinite(value) ? format_significant(value, kDigits) : std::string("open");
  };
  return p.name + " " + with_unit(p.value, p.unit) + " (95 %: " + bound(p.low95) + " to " +
         bound(p.high95) + ")";
}

std::string improvement_text(RigKind rig, const Errors& before, const Errors& after,
                             const Errors& noise_floor) {
  std::vector<std::string> words;
  for (const auto& [key, value] : before) {
    const std::string channel = channel_of_error(key), unit = channel_unit(rig, channel);
    std::string text = channel + " " + with_unit(value, "");
    if (const auto found = after.find(key); found != after.end()) {
      text += " -> " + with_unit(found->second, "");
    }
    if (!unit.empty()) text += " " + unit;
    if (const auto found = noise_floor.find(key); found != noise_floor.end()) {
      text += " (noise floor " + with_unit(found->second, "") + ")";
    }
    words.push_back(text);
  }
  return words.empty() ? "no recording of this role" : joined(words, "; ");
}

std::string where_text(const Verdict& verdict) {
  if (verdict.channels.empty()) return "nowhere in particular";
  std::string text = joined(verdict.channels, ", ");
  if (!verdict.condition.empty()) text += " where " + verdict.condition;
  std::vector<std::string> spans;
  for (const Interval& i : verdict.intervals) {
    if (spans.size() == kShownIntervals) break;
    spans.push_back(i.recording + " " + format_significant(i.start_s, kDigits) + " to " +
                    format_significant(i.end_s, kDigits) + " s");
  }
  if (!spans.empty()) text += "; " + joined(spans, ", ");
  if (verdict.intervals.size() > kShownIntervals) {
    text += " and " + std::to_string(verdict.intervals.size() - kShownIntervals) + " more";
  }
  return text;
}

std::vector<std::string> summary_lines(const Verdict& verdict, RigKind rig,
                                       const std::string& folder) {
  const Errors none;
  return {"answer      " + headline(verdict),
          "parameters  " + parameters_text(verdict),
          "where       " + where_text(verdict),
          "held out    " + improvement_text(rig, verdict.before.holdout, verdict.after.holdout,
                                            verdict.noise_floor),
          "fitted      " + improvement_text(rig, verdict.before.fit, verdict.after.fit, none),
          "else        " + rivals_text(verdict),
          "setup       " + setup_text(verdict),
          "data        " + quality_text(verdict),
          "next        " + (verdict.next_experiment.empty() ? "-" : verdict.next_experiment),
          "files       " + folder +
              "/report.html, verdict.json, improved.toml, residuals.csv, hypotheses.csv" +
              (verdict.planned_experiment ? ", next_experiment.toml, next_experiment.csv" : "")};
}

}  // namespace hoof::tools
