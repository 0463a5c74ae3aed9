// The flags that say who makes a campaign's runs.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/reproduce/campaign.h"

namespace hoof::tools {

/// --jobs, --threads, --engine and those of Slurm. `engine` must live until the command has run.
void add_engine_options(CLI::App& command, Engine& engine);

}  // namespace hoof::tools
