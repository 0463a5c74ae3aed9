#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "firmware/protocol/dbc.h"
#include "tools/cli/commands.h"
#include "tools/run/output_file.h"

namespace hoof::tools {

void add_dbc_command(CLI::App& app, Invocation& invocation) {
  auto out = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("dbc", "Print hoof.dbc: every CAN message of the foot");
  command->add_option("--out", *out, "Write it to a file instead")->type_name("FILE");
  command->footer(
      "Examples:\n"
      "  hoof dbc --out hoof.dbc\n"
      "  hoof dbc | grep BO_");
  command->callback([&invocation, out] {
    invocation.run = [out] {
      std::ostringstream text;
      firmware::protocol::write_dbc(text);
      if (out->empty()) {
        std::cout << text.str();
      } else {
        write_file(*out, text.str());
      }
    };
  });
}

}  // namespace hoof::tools
