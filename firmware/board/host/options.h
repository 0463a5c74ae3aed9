// Command line of hoof-firmware.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/app/parameters.h"

namespace hoof::firmware::board {

struct Options {
  std::string bus0;
  std::string bus1;        // the same as bus0 where one interface carries everything
  bool lock_step = false;  // the clock is a simulator's (hoof-bridge), not the wall's
  double patience_s = 60;  // wall time without a word of it until it is taken for dead
  double slow_down = 1.0;
  std::string flash;                  // file with what outlives the power; empty: nothing does
  std::vector<std::string> settings;  // name=value, checked
  std::string help;                   // of --help: to be printed, and no more
};

/// @throws CLI::ParseError for bad usage, with the text to print
Options read_options(int argc, char** argv);

/// Sets one parameter from "name=value". @return an empty string, else what is wrong with it
std::string apply_setting(app::Parameters& parameters, std::string_view setting);

/// Sets what the command line sets, over what is there.
void apply_settings(const Options& options, app::Parameters& parameters);

}  // namespace hoof::firmware::board
