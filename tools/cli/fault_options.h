#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace hoof::tools {

/// Faults to be put into a run.
struct FaultOptions {
  std::string file;                 ///< TOML with [[fault]] entries
  std::vector<std::string> faults;  ///< each "kind=drop,target=hip,at_s=1.2,for_s=0.05"
};

/// Adds --faults and --fault.
void add_fault_options(CLI::App& command, FaultOptions& options);

/// For the end of --help: kinds of fault, how one begins, what can be waited for.
std::string fault_help();

/// Those of --fault as settings; the file is merged by read_run_settings().
void add_fault_overrides(const FaultOptions& options, std::vector<std::string>& overrides);

}  // namespace hoof::tools
