// How a program of this project ends: one line on standard error, and a status
// (tools/run/errors.h).
#pragma once

#include <functional>
#include <string>

#include "tools/run/errors.h"

namespace hoof::tools {

/// Prints "program: message" in one line. @return the status
int complain(const std::string& program, std::string message, ExitStatus status);

/// Runs, and turns every exception into its line and status; 0 where there was none.
int run_to_status(const std::string& program, const std::function<void()>& run);

}  // namespace hoof::tools
