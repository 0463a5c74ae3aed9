#include "tools/diagnose/experiment_text.h"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/experiment_candidates.h"
#include "tools/diagnose/rig_keys.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/report/display_unit.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

std::string number(double value) {
  return format_significant(value, 3);
}

/// Digits of a value that is known to `sigma`: two of what is uncertain.
std::string rounded(double value, double sigma) {
  if (!(sigma > 0) || value == 0) return number(value);
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(sigma)) + 2;
  return format_significant(value, static_cast<int>(std::clamp(digits, 2.0, 6.0)));
}

std::string odds(double log10_odds) {
  if (log10_odds > 6) return "more than a million to one";
  const double to_one = std::pow(10.0, log10_odds);
  if (to_one < 100) return format_significant(to_one, 2) + " to one";
  const double digit = std::pow(10.0, std::floor(log10_odds));  // of the first
  return std::to_string(std::lround(digit * std::round(to_one / digit))) + " to one";
}

std::string meaning(const std::string& hypothesis) {
  if (hypothesis == "none") return "nothing missing";
  if (hypothesis.find("unlisted_") == std::string::npos) return hypothesis;
  return "something that is not in the list (stand-in: " + hypothesis + ")";
}

std::string outcome_text(const PlannedExperiment& plan, const ExpectedOutcome& outcome) {
  const std::string unit = channel_unit(plan.set.rig, plan.telling.channel);
  return rounded(outcome.reading, outcome.reading_sigma) + " +- " +
         format_significant(outcome.reading_sigma, 2) + (unit.empty() ? "" : " " + unit) +
         " means " + meaning(outcome.hypothesis);
}

std::string span_text(double from_s, double to_s) {
  if (from_s == to_s) return "at " + number(from_s) + " s";
  return "from " + number(from_s) + " to " + number(to_s) + " s";
}

/// "the mean of position from 20 to 20.8 s".
std::string reading_text(const TellingReading& t) {
  if (t.change) {
    return "the change of " + t.channel + ", mean " + span_text(t.from_s, t.to_s) + " less mean " +
           span_text(t.earlier_from_s, t.earlier_to_s) + ",";
  }
  return (t.from_s == t.to_s ? "" : "the mean of ") + t.channel + " " + span_text(t.from_s, t.to_s);
}

std::string setup_entry(const std::string& key, const SetupValue& v) {
  if (v.sigma <= 0) return key + " = " + format_number(v.value);
  return key + " = { value = " + format_number(v.value) + ", sigma = " + format_number(v.sigma) +
         " }";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

/// In a comment, which ends with its line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

/// What this recording has otherwise than the set.
std::string overrides(const Setup& own, const Setup& shared) {
  std::string text;
  for (const auto& [key, v] : own.values) {
    const SetupValue* other = shared.find(key);
    if (other != nullptr && other->value == v.value && other->sigma == v.sigma) continue;
    text += (text.empty() ? "" : ", ") + setup_entry(key, v);
  }
  if (own.law != shared.law) {
    text += (text.empty() ? "" : ", ") + std::string("law = ") + quoted(law_name(own.law));
  }
  return text;
}

}  // namespace

std::string experiment_sentence(const PlannedExperiment& plan) {
  const std::string apart =
      " are " + number(plan.sigmas) + " sigma apart, what is uncertain of both allowed for (" +
      odds(plan.log10_odds) + " to be expected), against " + number(plan.again_sigmas) +
      " if the best of the recordings given were made again";
  if (plan.open_loop) {
    std::string names;
    for (const ExpectedOutcome& o : plan.outcomes) {
      names += (names.empty() ? "" : " and ") + meaning(o.hypothesis);
    }
    return plan.action + ", by the torque of " + kExperimentTable + ": in " + plan.telling.channel +
           " " + names + apart;
  }
  constexpr double kTells = 2;  // sigmas of one reading
  const bool tells = plan.telling.sigmas >= kTells;
  std::string text = plan.action + " (" + kExperimentTable + "): " + reading_text(plan.telling) +
                     (tells ? " then tells, where " : " then differs most, where ");
  for (std::size_t i = 0; i < plan.outcomes.size(); ++i) {
    const bool last = i + 1 == plan.outcomes.size();
    text += (i == 0 ? "" : last ? " and " : ", ") + outcome_text(plan, plan.outcomes[i]);
  }
  text += "; over the whole recording " +
          std::string(plan.outcomes.size() > 2 ? "the nearest two" : "they") + apart;
  return text;
}

std::string experiment_csv(const PlannedExperiment& plan) {
  const Recording& r = plan.set.recordings.front();
  std::string text = "time";
  for (const std::string& name : plan.input_channels) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < r.time_s.size(); ++i) {
    text += format_number(r.time_s[i]);
    for (const std::string& name : plan.input_channels) {
      text += "," + format_number(r.channels.at(name)[i]);
    }
    text += "\n";
  }
  return text;
}

std::string experiment_toml(const PlannedExperiment& plan,
                            const std::vector<std::string>& data_sets) {
  const DataSet& set = plan.set;
  const Recording& r = set.recordings.front();
  std::string inputs, outputs, given;
  for (const std::string& name : plan.input_channels) inputs += (inputs.empty() ? "" : ", ") + name;
  for (const std::string& name : plan.output_channels) {
    outputs += (outputs.empty() ? "" : ", ") + name;
  }
  for (const std::string& name : data_sets) given += one_line(name) + " ";
  std::string text = "# The experiment that would decide: " + one_line(plan.action) + ".\n# Play " +
                     kExperimentTable + " beside this file (time; " + inputs +
                     "; SI) and record, in " + r.name + ",\n# time, " + inputs +
                     " as they were, and " + outputs + ". Then:\n#   hoof diagnose " + given +
                     kExperimentFile + " --out DIR\n# Noise and setup are as the data set " +
                     one_line(set.name) + " states them; change what was otherwise.\n\n" +
                     "format = 1\nname = " + quoted(set.name + ", next experiment") +
                     "\nrig = " + quoted(rig_name(set.rig)) + "\n";
  if (!set.noise.empty()) {
    text += "noise = { ";
    const char* between = "";
    for (const auto& [name, sigma] : set.noise) {
      text += between + name + " = " + format_number(sigma);
      between = ", ";
    }
    text += " }\n";
  }
  text += "\n[setup]\n";
  if (set.setup.law != DriveLaw::kNone) text += "law = " + quoted(law_name(set.setup.law)) + "\n";
  for (const auto& [key, v] : set.setup.values) text += setup_entry(key, v) + "\n";
  text += "\n[channels]\ntime = \"time\"\n";
  for (const auto* names : {&plan.input_channels, &plan.output_channels}) {
    for (const std::string& name : *names) text += name + " = " + quoted(name) + "\n";
  }
  text += "\n[[recording]]\ndata = " + quoted(r.name) + "\nrole = \"fit\"\n";
  const std::string own = overrides(r.setup, set.setup);
  if (!own.empty()) text += "setup = { " + own + " }\n";
  return text;
}

}  // namespace hoof::tools
