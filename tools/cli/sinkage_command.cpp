#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/experiment_options.h"

namespace hoof::tools {

void add_sinkage_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command =
      app.add_subcommand("sinkage", "Stand a loaded foot in sand, its toes held by the firmware");
  add_experiment_options(*command, *options, Experiment::kSinkage);
  command->callback([&invocation, options] {
    invocation.run = [options] { run_or_resume(*options, Experiment::kSinkage); };
  });
}

}  // namespace hoof::tools
