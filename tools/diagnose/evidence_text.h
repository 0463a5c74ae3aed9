// The reasons of a verdict, in sentences.
#pragma once

#include "tools/diagnose/judge.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Fills evidence_for and evidence_against.
void write_evidence(const Judgement& judgement, const Fitter& fitter, const Fit& none,
                    const Fit& winner, Verdict& verdict);

/// The stand-in that took the place of what the list does not hold.
UnknownTerm describe_unknown(const Fitter& fitter, const Fit& none, const Fit& stand_in,
                             const std::vector<std::string>& channels, const Errors& holdout);

}  // namespace hoof::tools
