// The program hoof-bridge: the plant of an experiment, its drives and the SYNC master on a CAN bus,
// for a firmware that is elsewhere on it.

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "tools/cli/bus_options.h"
#include "tools/cli/exit_status.h"
#include "tools/cli/fault_options.h"
#include "tools/cli/run_options.h"
#include "tools/experiment/run_experiment.h"

namespace {

using namespace hoof::tools;

struct BridgeOptions {
  std::string experiment = "sinkage";
  std::string terrain;
  BusOptions bus;
  FaultOptions faults;
  std::string effects;
  std::filesystem::path conceal;
  RunOptions run;
};

void add_options(CLI::App& app, BridgeOptions& options) {
  app.add_option("--experiment", options.experiment, "sinkage, traction, or a TOML file of one")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  add_bus_options(app, options.bus)->required();
  app.add_option("--terrain", options.terrain, "Grains (dem), a fast law (rft) or a rigid plane")
      ->type_name("dem|rft|rigid")
      ->check(CLI::IsMember({"dem", "rft", "rigid"}));
  add_fault_options(app, options.faults);
  add_effect_options(app, options.effects, options.conceal);
  add_run_options(app, options.run);
  app.footer(
      fault_help() +
      "The firmware must be on the bus already; its parameters are set from here, over the bus.\n"
      "Examples:\n"
      "  hoof-firmware --bus vcan0 --clock lock-step &\n"
      "  hoof-bridge --bus vcan0 --experiment sinkage\n"
      "  hoof-bridge --bus can0,can1 --clock real-time --experiment traction --terrain rigid\n"
      "`hoof sinkage --bus vcan0` starts and ends both.");
}

void run(const BridgeOptions& options) {
  const double no_checkpoints = 0;  // a firmware elsewhere cannot be taken back to one
  const RunOutput output{options.run.out,   options.run.force, options.run.live,
                         options.run.quiet, no_checkpoints,    bus_choice(options.bus),
                         options.conceal};
  std::vector<std::string> overrides = {"experiment.bus=\"" + options.bus.bus + "\""};
  if (!options.terrain.empty()) {
    overrides.push_back("experiment.terrain=\"" + options.terrain + "\"");
  }
  if (options.run.seed) overrides.push_back("experiment.seed=" + std::to_string(*options.run.seed));
  if (options.run.threads) {
    overrides.push_back("experiment.threads=" + std::to_string(*options.run.threads));
  }
  overrides.insert(overrides.end(), options.run.settings.begin(), options.run.settings.end());
  add_fault_overrides(options.faults, overrides);
  run_experiment(
      read_run_settings(options.experiment, overrides, options.faults.file, options.effects),
      output);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("The plant of an experiment on a CAN bus, for a firmware that is elsewhere on it.");
  app.name("hoof-bridge");
  BridgeOptions options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain("hoof-bridge", error.what(), ExitStatus::kUserError);
  }
  return run_to_status("hoof-bridge", [&] { run(options); });
}
