#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/experiment_options.h"

namespace hoof::tools {

void add_traction_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "traction", "Pull a foot through sand along the stance ellipse, driven by the firmware");
  add_experiment_options(*command, *options, Experiment::kTraction);
  command->callback([&invocation, options] {
    invocation.run = [options] { run_or_resume(*options, Experiment::kTraction); };
  });
}

}  // namespace hoof::tools
