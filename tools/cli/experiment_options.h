#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/cli/bus_options.h"
#include "tools/cli/fault_options.h"
#include "tools/cli/run_options.h"
#include "tools/experiment/run_experiment.h"

namespace hoof::tools {

enum class Experiment { kSinkage, kTraction };

/// The flags of `hoof sinkage` and `hoof traction`. A field left empty was not given, and the
/// settings' own default holds. Values are checked as they are parsed: a CLI::ValidationError
/// names flag, value and bound.
struct ExperimentOptions {
  RunOptions run;
  std::string foot;                 ///< bionic, bionic-plain, traditional or a path ending in .stl
  std::string load;                 ///< "40" or "40kg": a mass; "400N": a force
  std::string load_as;              ///< force or mass: how the load acts on the foot
  std::string speed;                ///< m/s, downward at first contact (sinkage)
  std::string frequency;            ///< Hz, of the stance ellipse (traction)
  std::string toe;                  ///< degrees per side, 0..40
  std::string bed;                  ///< preset demo, medium, bench, paper, or a file
  std::string terrain;              ///< dem, rft or rigid
  std::string soil;                 ///< of rft: preset or file
  std::string fields;               ///< none, report or vtk
  std::string drive;                ///< firmware or prescribed
  BusOptions bus;                   ///< not given: firmware and plant in this process
  std::string firmware;             ///< host, emulated or qemu
  FaultOptions faults;              ///< put in on the way; none in a clean run
  std::string effects;              ///< file of physics beyond the nominal plant
  std::filesystem::path conceal;    ///< where those are told, and nowhere else
  std::filesystem::path resume;     ///< folder of an unfinished run; its settings hold, not these
  double checkpoint_every_min = RunOutput().checkpoint_every_s / 60;
};

/// Adds the flags that `experiment` has, and the run flags, to `command`.
void add_experiment_options(CLI::App& command, ExperimentOptions& options, Experiment experiment);

/// Runs the experiment that the flags ask for, or finishes the one of --resume.
void run_or_resume(const ExperimentOptions& options, Experiment experiment);

/// The flags as settings, "experiment.toe_deg=30": in the order above, those of --set last, so
/// that a later entry wins. For sim::Settings::load_experiment. Text values are TOML strings,
/// quoted and escaped.
std::vector<std::string> settings_overrides(const ExperimentOptions& options);

}  // namespace hoof::tools
