#pragma once

#include <string>
#include <vector>

#include "tools/conceal/answer.h"
#include "tools/conceal/truth.h"

namespace hoof::tools::conceal {

/// What a method says of a case, in the one form in which all methods are compared.
struct Pick {
  std::string verdict;             ///< as the contract's
  std::vector<std::string> names;  ///< of effects, the most probable first
  std::vector<std::vector<std::string>> alike;
  std::size_t sure = 2;  ///< so many of the names are more likely there than not
};

Pick pick_of(const Answer& answer);
/// "none", "unknown", "a", "a+b".
Pick pick_named(const std::string& name);

/// Is the pick what the contract's table asks for in a case of this kind? A pair is right where
/// both are among the first two names; "not separable" where one of its sets holds the hidden
/// effect and another that is as likely.
bool right(const TruthCase& truth, const Pick& pick);

/// Short text of truth and pick: "none", "unknown", "a", "a+b", "a|b" for what is not separable.
std::string label(const TruthCase& truth);
std::string label(const Pick& pick);

/// Picks of the baselines from what the tool wrote down: least AIC and least BIC; empty where it
/// wrote nothing.
std::vector<std::string> pick_by_aic(const Answer& answer);
std::vector<std::string> pick_by_bic(const Answer& answer);

}  // namespace hoof::tools::conceal
