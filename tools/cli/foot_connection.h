// A foot on a CAN bus, for commands that ask it something.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "hil_bridge/service_client.h"

namespace hoof::tools {

struct FootFlags {
  std::string bus;
  int id = 2;  // supervisor 1 is that of hoof's own runs
  double timeout_s = 2;
};

/// Adds --bus (returned, required), --id and --timeout.
CLI::Option* add_foot_flags(CLI::App& command, FootFlags& flags);

/// Opens the bus, connects and does the work.
/// @throws CannotFinish where nobody answers or the foot refuses, saying why
void with_foot(const FootFlags& flags, const std::function<void(bridge::ServiceClient&)>& work);

/// The same with a foot whose table of parameters may be another than this program's.
void with_any_foot(const FootFlags& flags, const std::function<void(bridge::ServiceClient&)>& work);

}  // namespace hoof::tools
