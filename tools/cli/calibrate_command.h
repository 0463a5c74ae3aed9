#pragma once

#include <CLI/CLI.hpp>

#include "tools/cli/invocation.h"

namespace hoof::tools {

/// hoof calibrate and its laboratories.
void add_calibrate_command(CLI::App& app, Invocation& invocation);

}  // namespace hoof::tools
