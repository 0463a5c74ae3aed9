// A verdict in words, for the terminal and for the report.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// "rad"; empty where none is known.
std::string channel_unit(RigKind rig, const std::string& channel);

/// The channel of a key of errors: "position_rmse" -> "position".
std::string channel_of_error(const std::string& key);

/// Two decimals; never "1.00" or "0.00", which no finite data prove.
std::string probability_text(double probability);

/// A number with a unit in three digits: "0.0312 rad", of unit "1" the number alone; "diverged"
/// where it is not finite.
std::string with_unit(double value, const std::string& unit);

/// The finding of an effect, or null.
const EffectFinding* find_finding(const Verdict& verdict, const std::string& name);

/// Named effects, then the other members of sets that cannot be told apart.
std::vector<std::string> effects_in_question(const Verdict& verdict);

/// The answer in one sentence, with its probability.
std::string headline(const Verdict& verdict);

/// "amplitude 0.031 Nm (95 %: 0.027 to 0.035)".
std::string parameter_text(const ParameterEstimate& estimate);

/// "position: 0.0702 to 0.0312 rad, noise floor 0.003"; one per channel, joined by "; ".
std::string improvement_text(RigKind rig, const Errors& before, const Errors& after,
                             const Errors& noise_floor);

/// Where it shows, in one line: channels, spans of time, condition.
std::string where_text(const Verdict& verdict);

/// Ten lines for the terminal.
/// @param folder that holds the files
std::vector<std::string> summary_lines(const Verdict& verdict, RigKind rig,
                                       const std::string& folder);

}  // namespace hoof::tools
