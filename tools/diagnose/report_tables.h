// The sections of report.html that are tables.
#pragma once

#include <string>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Ranked hypotheses, and what the named effects are.
std::string what_html(const Verdict& verdict);

/// Errors before and after, and those of the rivals.
std::string how_much_html(const Verdict& verdict, RigKind rig);

std::string setup_html(const Verdict& verdict);

/// Strength of a difference of log evidence, as Kass and Raftery put it (Bayes Factors, JASA 90,
/// 1995): "very strong evidence for it".
std::string evidence_words(double evidence);

}  // namespace hoof::tools
