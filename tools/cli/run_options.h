#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hoof::tools {

/// Flags that every command which makes a run folder has.
struct RunOptions {
  std::filesystem::path out;         ///< empty: runs/<experiment>-<date>-<n>
  bool force = false;                ///< replace an earlier run folder of the same name
  std::optional<std::int64_t> seed;  ///< 0 or above; TOML has no larger integers
  std::optional<int> threads;
  std::vector<std::string> settings;  ///< each "key=value", as given by --set
  bool live = false;                  ///< telemetry over LCM while running
  bool quiet = false;                 ///< no progress
};

/// Adds --effects and --conceal: physics beyond the nominal plant, and where it is told of it.
void add_effect_options(CLI::App& command, std::string& effects, std::filesystem::path& conceal);

/// Adds --out --force --seed --threads --set --live --quiet to `command`.
void add_run_options(CLI::App& command, RunOptions& options);

}  // namespace hoof::tools
