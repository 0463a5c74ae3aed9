// The program behind tools/hoof: parses the command line, runs one command, and turns every
// failure into one line on standard error and an exit status (tools/run/errors.h).

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "tools/cli/commands.h"
#include "tools/cli/invocation.h"
#include "tools/run/errors.h"

namespace {

using namespace hoof::tools;

int complain(std::string message, int status) {
  // Some libraries break their messages over lines; the user gets one.
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::cerr << "hoof: " << message << std::endl;
  return status;
}

int complain(const std::string& message, ExitStatus status) {
  return complain(message, static_cast<int>(status));
}

// CLI11 reports an unknown command as "the following arguments were not expected".
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const auto commands = app.get_subcommands({});
  std::string names;
  bool known = false;
  for (const CLI::App* command : commands) {
    known |= argc > 1 && command->get_name() == argv[1];
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  if (argc < 2) return "no command given; known are " + names;
  if (!known && argv[1][0] != '-') {
    return "unknown command '" + std::string(argv[1]) + "'; known are " + names;
  }
  return std::string(known ? argv[1] : "") + (known ? ": " : "") + error.what();
}

int run_invocation(const Invocation& invocation) {
  try {
    invocation.run();
    return EXIT_SUCCESS;
  } catch (const Interrupted& stop) {
    return complain(stop.what(), stop.exit_status());
  } catch (const UserError& error) {
    return complain(error.what(), ExitStatus::kUserError);
  } catch (const std::exception& error) {
    return complain(error.what(), ExitStatus::kCannotFinish);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Firmware of a goat-like foot in a bed of grains: tests, runs and reports.");
  app.name("hoof");
  app.footer(
      "tools/hoof test [--full] [ctest arguments] builds and runs all tests.\n"
      "hoof COMMAND --help shows a command's flags and examples.");
  app.require_subcommand(1);

  Invocation invocation;
  add_report_command(app, invocation);
  add_version_command(app, invocation);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return complain(explain(app, error, argc, argv), ExitStatus::kUserError);
  }
  return run_invocation(invocation);
}
