// What to measure next where recordings do not decide.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/judge.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Fills next_experiment and planned_experiment where the verdict leaves more than one hypothesis
/// standing: by simulating both in what could be done on the machine, else in the words of the
/// catalogue. Leaves them empty where the verdict is decided.
/// @param fitter, judgement of these data sets
void plan_next_experiment(const Fitter& fitter, const std::vector<DataSet>& sets,
                          const Judgement& judgement, int threads, Verdict& verdict);

}  // namespace hoof::tools
