#pragma once

#include <CLI/CLI.hpp>

#include "tools/cli/invocation.h"

namespace hoof::tools {

/// Adds `faults` to `hoof study`.
void add_fault_matrix(CLI::App& study, Invocation& invocation);

}  // namespace hoof::tools
