#pragma once

#include "tools/conceal/case_data.h"
#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"
#include "tools/conceal/servo_hide.h"
#include "tools/conceal/servo_plan.h"

namespace hoof::tools::conceal {

/// Draws machines until one hides what is asked for so that it can be seen at all; CannotFinish
/// where a hundred do not.
CaseData make_servo_case(const std::string& name, const CaseRequest& request,
                         const RandomStream& random);

/// The case of a plan with what is hidden in it.
CaseData finish_servo_case(const std::string& name, const CaseRequest& request,
                           const ServoPlan& plan, const HiddenInServo& hidden,
                           const RandomStream& random);

/// The recordings of a plan as they are written: noise, missing samples, units.
CaseData record_servo(const std::string& name, const ServoPlan& plan,
                      const std::vector<ServoSignals>& clean, RandomStream random);

}  // namespace hoof::tools::conceal
