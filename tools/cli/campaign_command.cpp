#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/reproduce/status.h"
#include "tools/reproduce/worker.h"

namespace hoof::tools {
namespace {

void add_status(CLI::App& parent, Invocation& invocation) {
  auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* command = parent.add_subcommand("status", "Done, under way, failed, time left");
  command->add_option("folder", *folder, "Of hoof reproduce or hoof claims")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->footer("Example:\n  hoof campaign status runs/reproduce-demo");
  command->callback([&invocation, folder] {
    invocation.run = [folder] { std::cout << campaign_status(*folder); };
  });
}

void add_run(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<WorkerOptions>();
  CLI::App* command =
      parent.add_subcommand("run", "One run of a campaign, as the jobs of --engine slurm call it");
  command->add_option("folder", options->campaign, "Of hoof reproduce or hoof claims")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("id", options->id, "Of the run, as in DIR/manifest.json")
      ->type_name("ID")
      ->required();
  command->add_flag("--bed-only", options->bed_only, "Only make the bed that it needs");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->add_option("--parent", options->parent, "End with this process")->group("");
  command->footer(
      "Does nothing where the run is done or another process is making it. SIGUSR1 stops it with "
      "a\n"
      "checkpoint; the next call goes on from there.\n"
      "Examples:\n"
      "  hoof campaign run runs/reproduce-demo traction-traditional-0.45Hz-bed1\n"
      "  sed -n 's/.*\"id\": \"\\(.*\\)\".*/\\1/p' DIR/manifest.json | parallel hoof campaign run "
      "DIR");
  command->callback([&invocation, options] { invocation.run = [options] { work(*options); }; });
}

}  // namespace

void add_campaign_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("campaign", "Runs of reproduce and claims: how far they are, one of them");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof campaign status runs/reproduce-demo\n"
      "  hoof campaign run runs/reproduce-demo traction-traditional-0.45Hz-bed1");
  add_status(*command, invocation);
  add_run(*command, invocation);
}

}  // namespace hoof::tools
