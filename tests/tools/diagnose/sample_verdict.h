// Verdicts made by hand, of a pendulum.
#pragma once

#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tests {

/// missing_physics: cogging_torque, in two recordings, one of them held out.
tools::Verdict sample_verdict();

/// The same data, and nothing missing.
tools::Verdict sample_verdict_none();

/// Two effects that the data cannot tell apart.
tools::Verdict sample_verdict_not_separable();

/// Something that is not in the list.
tools::Verdict sample_verdict_unknown();

/// The data set that the verdicts speak of, without samples.
std::vector<tools::DataSet> sample_data_sets();

}  // namespace hoof::tests
