// verdict.json: section 2 of the contract.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Keys in the contract's order; after those, `setup` and `data_quality`, which are ours.
/// Effects are those of probability 0.01 and above, and those that are named whatever theirs.
/// What is not finite is left out: an error that diverged has no key, and a bound of an interval
/// that is open ends at the parameter's own bound.
nlohmann::ordered_json verdict_json(const Verdict& verdict);

}  // namespace hoof::tools
