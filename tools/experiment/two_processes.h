// hoof-firmware and hoof-bridge as two processes on one CAN interface, started and ended together.
#pragma once

#include <string>
#include <vector>

namespace hoof::tools {

struct TwoProcesses {
  std::string bus;                            // "vcan0", or one interface for each bus
  std::vector<std::string> firmware_options;  // beside --bus
  std::vector<std::string> bridge_options;    // beside --bus
};

/// Runs both until the bridge is done; the firmware is then told to end, and killed where it does
/// not. Ctrl-C goes to the bridge, which ends the run in order. Where this process dies, both end.
/// @throws UserError where another foot is on the bus already, CannotFinish where a program is not
/// there or the bridge was killed, AlreadySaid with the bridge's status where it failed
void run_two_processes(const TwoProcesses& what);

}  // namespace hoof::tools
