#pragma once

#include <string>

#include "tools/conceal/case_data.h"
#include "tools/conceal/deck.h"
#include "tools/conceal/random_stream.h"

namespace hoof::tools::conceal {

/// What the `index`th case of a rig is to hide where two effects must look alike; goes round the
/// ways in which they can.
CaseRequest alike_request(const std::string& rig, std::size_t index);

/// A case in which the recordings cannot tell the effects of `request.alike` apart: by what is
/// done with the machine, not by noise.
CaseData make_alike_case(const std::string& name, const DealtCase& dealt,
                         const RandomStream& random);

}  // namespace hoof::tools::conceal
