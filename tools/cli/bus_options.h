#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/experiment/run_bus.h"

namespace hoof::tools {

/// Flags of a run whose firmware is another process, or a board.
struct BusOptions {
  std::string bus;  ///< CAN interface such as vcan0; not given: the in-process bus
  std::string clock = "lock-step";
  double patience_s = BusChoice().patience_s;
};

/// Adds --bus (returned), --clock and --patience.
CLI::Option* add_bus_options(CLI::App& command, BusOptions& options);

BusChoice bus_choice(const BusOptions& options);

}  // namespace hoof::tools
