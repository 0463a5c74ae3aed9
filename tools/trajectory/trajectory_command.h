#pragma once

#include <CLI/CLI.hpp>

namespace hoof::tools {

// Adds `trajectory check|random|solve`. A missed bar or a refused input ends parsing with
// CLI::RuntimeError(exit code), which CLI::App::exit() turns into that exit code.
void add_trajectory_command(CLI::App& app);

}  // namespace hoof::tools
