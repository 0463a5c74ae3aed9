#include <iostream>

#include "tools/cli/commands.h"
#include "tools/run/version.h"

namespace hoof::tools {

void add_version_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("version", "Print what this program was built from");
  command->footer("Example:\n  hoof version");
  command->callback([&invocation] {
    invocation.run = [] {
      const Version version = build_version();
      std::cout << "code      " << version.code << "\n"
                << "compiler  " << version.compiler << "\n"
                << "build     " << version.build_type << "\n";
    };
  });
}

}  // namespace hoof::tools
