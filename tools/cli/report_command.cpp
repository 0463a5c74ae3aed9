#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/report/report.h"

namespace hoof::tools {

void add_report_command(CLI::App& app, Invocation& invocation) {
  auto run_folder = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("report", "Make report.html of a run folder again");
  command->add_option("RUN_DIR", *run_folder, "Folder with result.json, samples.csv, settings.toml")
      ->required();
  command->footer("Example:\n  hoof report runs/sinkage-2026-01-31-1");
  command->callback([&invocation, run_folder] {
    invocation.run = [run_folder] { std::cout << write_report(*run_folder).string() << "\n"; };
  });
}

}  // namespace hoof::tools
