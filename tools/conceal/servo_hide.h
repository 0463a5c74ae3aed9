#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"
#include "tools/conceal/seen_change.h"
#include "tools/conceal/servo_sizes.h"

namespace hoof::tools::conceal {

/// What is hidden in a plan, and how it is seen.
struct HiddenInServo {
  std::vector<HiddenEffect> effects;
  std::vector<ServoSignals> signals;
  std::vector<SeenChange> changes;  ///< of each effect, the others being there
  SeenChange together;
};

/// Hides the effects of a request in a plan, each larger until it is seen; false where that fails.
/// `adapt` may change the numbers of an effect that was drawn.
bool hide_in_servo(const CaseRequest& request, const ServoPlan& plan, const ServoScale& scale,
                   const RandomStream& random, HiddenInServo& hidden,
                   const std::function<void(HiddenEffect&)>& adapt = {});

bool all_sane(const std::vector<ServoSignals>& signals);

}  // namespace hoof::tools::conceal
