#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/conceal/intervals.h"

namespace hoof::tools::conceal {

struct AnsweredParameter {
  double value = 0.0, low = 0.0, high = 0.0;
};

struct AnsweredEffect {
  std::string name;
  double probability = 0.0;
  std::map<std::string, AnsweredParameter> parameters;
};

/// One alternative of hypotheses.csv, which the tool may leave beside its verdict.
struct AnsweredHypothesis {
  std::string name;
  double parameters_count = 0, log_likelihood = 0, samples_count = 0;
};

/// A verdict.json of the contract's section 2, as far as it is graded.
struct Answer {
  std::string verdict;
  std::map<std::string, double> probabilities;
  std::vector<AnsweredEffect> effects;
  std::vector<std::vector<std::string>> not_separable;
  std::vector<std::string> channels;
  std::vector<TimeInterval> intervals;
  std::map<std::string, double> holdout_before, holdout_after;
  std::vector<AnsweredHypothesis> hypotheses;
  double seconds = -1.0;  ///< negative where nobody took the time
};

/// Reads the answer in a folder; UserError names file and key where it is missing or malformed.
Answer read_answer(const std::filesystem::path& folder);

}  // namespace hoof::tools::conceal
