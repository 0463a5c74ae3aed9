#pragma once

#include <vector>

#include "tests/architecture/source_file.h"

namespace hoof::tests {

/// Numbers in the TOML files of sim/config whose key neither ends in a unit of sim/config/units.h
/// nor is a known pure number. Where a value stands in a table of its own, {value, sigma, source},
/// the table's key carries the unit. `files` must hold sim/config/units.h.
std::vector<Finding> check_toml_units(const std::vector<SourceFile>& files);

}  // namespace hoof::tests
