#include "tools/replay/replay_command.h"

#include <iostream>
#include <memory>

#include "tools/cli/commands.h"

namespace hoof::tools {

void add_replay_command(CLI::App& app, Invocation& invocation) {
  auto request = std::make_shared<ReplayRequest>();
  CLI::App* command =
      app.add_subcommand("replay", "Let a recorded bus drive the firmware and compare its answers");
  command->add_option("RUN", request->recording, "Folder of a run, or its bus.log")->required();
  command->add_option("--to-tick", request->to_tick, "Stop after this control tick, show the state")
      ->type_name("N");
  command->footer(
      "Exit status: 0 all answers are the recorded ones, 1 the first difference is printed.\n"
      "Examples:\n"
      "  hoof replay runs/sinkage-2026-01-31-1\n"
      "  hoof replay runs/sinkage-2026-01-31-1 --to-tick 812\n"
      "  gdb -ex 'break hoof_replay_at_tick' -ex run --args hoof replay RUN --to-tick 812");
  command->callback([&invocation, request] {
    invocation.run = [request] { replay_recording(*request, std::cout); };
  });
}

}  // namespace hoof::tools
