#pragma once

#include "tools/conceal/servo_plan.h"

namespace hoof::tools::conceal {

/// Least misfit (sum of squares over the noise, and over the doubt of the nominal parameters) with
/// which `rival` can stand in for what is hidden, by Levenberg and Marquardt from the rival's
/// numbers on. Below about 4 no test of this data can tell the two apart.
double rival_misfit(const ServoPlan& plan, const std::vector<HiddenEffect>& hidden,
                    const HiddenEffect& rival);

}  // namespace hoof::tools::conceal
