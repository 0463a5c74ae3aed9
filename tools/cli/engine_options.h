// The flags that the commands of campaigns share: on which ground, and who makes the runs.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/ground.h"

namespace hoof::tools {

/// --scale and --terrain. `ground` must live until the command has run.
void add_ground_options(CLI::App& command, Ground& ground);

/// --jobs, --threads, --engine and those of Slurm. `engine` must live until the command has run.
void add_engine_options(CLI::App& command, Engine& engine);

}  // namespace hoof::tools
