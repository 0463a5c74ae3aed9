// Command line of hoof-firmware.
#pragma once

#include <string>

#include "firmware/app/parameters.h"

namespace hoof::firmware::board {

struct Options {
  std::string bus0;
  std::string bus1;  // the same as bus0 where one interface carries everything
  double slow_down = 1.0;
  app::Parameters parameters;
};

/// @throws CLI::ParseError for bad usage (also for --help), with the text to print
Options read_options(int argc, char** argv);

}  // namespace hoof::firmware::board
