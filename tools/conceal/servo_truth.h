#pragma once

#include "tools/conceal/case_data.h"
#include "tools/conceal/case_request.h"
#include "tools/conceal/seen_change.h"

namespace hoof::tools::conceal {

/// The entry of truth.json for a case.
nlohmann::ordered_json servo_truth(const CaseRequest& request, const ServoPlan& plan,
                                   const std::vector<HiddenEffect>& hidden,
                                   const std::vector<ServoSignals>& signals,
                                   const SeenChange& change);

/// Root mean square error of each predicted channel over the held-out recordings, of the plant that
/// knows everything but the noise, started as the contract starts a rollout.
nlohmann::ordered_json truth_holdout_rmse(const ServoPlan& plan,
                                          const std::vector<HiddenEffect>& hidden,
                                          const CaseData& recorded);

/// name, parameters (value, unit and, where there are any, period and other readings).
nlohmann::ordered_json to_json(const HiddenEffect& effect);
nlohmann::ordered_json to_json(const SeenChange& change);

}  // namespace hoof::tools::conceal
