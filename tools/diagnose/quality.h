// What is wrong, or odd, about recordings, before anybody looks for physics in them.
#pragma once

#include <vector>

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

/// Gaps, clocks, dead and saturated channels, units, signs, noise, excitation, duplicates. What
/// is found alike in several recordings is one note, at the recording where it is worst. Serious
/// ones first.
std::vector<QualityNote> check_quality(const DataSet& set);

}  // namespace hoof::tools
