// What to measure next where recordings do not decide.
#pragma once

#include <string>

#include "tools/diagnose/judge.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Empty where the verdict is decided.
std::string next_experiment(const Judgement& judgement, const Verdict& verdict);

}  // namespace hoof::tools
