// The files of hoof diagnose.
#pragma once

#include <vector>

#include "tools/diagnose/answer_folder.h"
#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

inline constexpr char kVerdictFile[] = "verdict.json";

/// verdict.json, report.html, improved.toml, residuals.csv and hypotheses.csv; where an experiment
/// was planned, next_experiment.toml and next_experiment.csv.
void write_answer(const Verdict& verdict, const std::vector<DataSet>& data_sets,
                  AnswerFolder& folder);

}  // namespace hoof::tools
