// hoof log spy: the bus, or LCM channels, live, in a terminal.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace hoof::tools {

struct SpyRequest {
  std::string bus;                  // SocketCAN interfaces "vcan0" or "can0,can1"; or else
  std::optional<std::string> lcm;   // an LCM address, "" for its default; or else
  std::filesystem::path recording;  // a log, possibly one that is still being written, or a folder
  bool once = false;  // print what is there and end; so, too, where the output is no terminal
};

/// Shows the view until q is pressed or a signal ends it; leaves the terminal as it was.
/// @throws UserError where the log cannot be read, std::runtime_error naming an interface
void spy(const SpyRequest& request);

}  // namespace hoof::tools
