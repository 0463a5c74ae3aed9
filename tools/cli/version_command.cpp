#include <iostream>
#include <sstream>
#include <string>

#include "tools/cli/commands.h"
#include "tools/run/version.h"

namespace hoof::tools {
namespace {

std::string version_text() {
  const Version version = build_version();
  std::ostringstream text;
  text << "code      " << version.code << "\n"
       << "compiler  " << version.compiler << "\n"
       << "build     " << version.build_type;
  return text.str();
}

}  // namespace

void add_version_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("version", "Print what this program was built from");
  command->footer("Example:\n  hoof version");
  command->callback(
      [&invocation] { invocation.run = [] { std::cout << version_text() << "\n"; }; });
  app.set_version_flag("--version", version_text, "The same as hoof version");
}

}  // namespace hoof::tools
