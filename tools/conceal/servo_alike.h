#pragma once

#include <cstddef>
#include <string>

#include "tools/conceal/case_data.h"
#include "tools/conceal/case_request.h"
#include "tools/conceal/random_stream.h"

namespace hoof::tools::conceal {

CaseRequest servo_alike_request(std::size_t index);
CaseData make_servo_alike_case(const std::string& name, const CaseRequest& request,
                               const RandomStream& random);

}  // namespace hoof::tools::conceal
