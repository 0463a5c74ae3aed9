#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/faults.h"
#include "tools/cli/foot_connection.h"

namespace hoof::tools {

void add_faults_command(CLI::App& app, Invocation& invocation) {
  struct Options {
    FootFlags foot;
    bool trace = false;
    bool erase = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("faults", "Fault log that a foot keeps without power");
  add_foot_flags(*command, options->foot);
  command->add_flag("--trace", options->trace, "Also the ticks before each fault");
  command->add_flag("--erase", options->erase, "Empty the log when it has been printed");
  command->footer(
      "Examples:\n"
      "  hoof faults --bus can0 --trace\n"
      "  hoof faults --bus can0 --erase");
  command->callback([&invocation, options] {
    invocation.run = [options] {
      with_foot(options->foot, [&](bridge::ServiceClient& client) {
        print_fault_log(client, options->trace, std::cout);
        if (!options->erase) return;
        client.erase_fault_log();
        std::cout << "erased\n";
      });
    };
  });
}

}  // namespace hoof::tools
