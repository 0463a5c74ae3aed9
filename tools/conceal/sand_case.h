#pragma once

#include "tools/conceal/case_data.h"
#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"

namespace hoof::tools::conceal {

/// A case of the rig plate_sand; where the rig bends, half of them with a press on a rigid block
/// beside it (rigid.toml).
CaseData make_sand_case(const std::string& name, const CaseRequest& request,
                        const RandomStream& random);

/// Presses in which rate and packing look alike: each one quicker than the one before.
CaseRequest sand_alike_request();

}  // namespace hoof::tools::conceal
