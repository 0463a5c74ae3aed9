// The program behind tools/hoof: parses the command line, runs one command, and turns every
// failure into one line on standard error and an exit status (tools/run/errors.h).

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "sim/config/config_error.h"
#include "tools/cli/commands.h"
#include "tools/cli/invocation.h"
#include "tools/run/errors.h"
#include "tools/trajectory/trajectory_command.h"

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

// Where the first word is no command CLI11 says "a subcommand is required", whatever it was.
std::string explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  std::string names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == first) return first + ": " + error.what();
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  if (first.empty()) return "no command given; known are " + names;
  return "unknown command '" + first + "'; known are " + names;
}

int run_invocation(const Invocation& invocation) {
  try {
    invocation.run();
    return EXIT_SUCCESS;
  } catch (const Interrupted& stop) {
    return complain(stop.what(), stop.exit_status());
  } catch (const UserError& error) {
    return complain(error.what(), ExitStatus::kUserError);
  } catch (const hoof::sim::ConfigError& error) {
    return complain(error.what(), ExitStatus::kUserError);
  } catch (const std::invalid_argument& error) {
    // Settings that are possible one by one but not together.
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
      "tools/hoof benchmark dem|boundary|terrain|trajectory measures speed.\n"
      "tools/hoof firmware build|size|flash makes, measures and flashes the board's image.\n"
      "hoof COMMAND --help shows a command's flags and examples.");
  app.require_subcommand(1);

  Invocation invocation;
  add_sinkage_command(app, invocation);
  add_traction_command(app, invocation);
  add_study_command(app, invocation);
  add_terrain_command(app, invocation);
  add_bed_command(app, invocation);
  add_order_command(app, invocation);
  add_param_command(app, invocation);
  add_faults_command(app, invocation);
  add_dbc_command(app, invocation);
  add_trajectory_command(app);
  add_report_command(app, invocation);
  add_version_command(app, invocation);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::RuntimeError& done) {
    return done.get_exit_code();  // a command that has said itself what is wrong
  } catch (const CLI::ParseError& error) {
    return complain(explain(app, error, argc, argv), ExitStatus::kUserError);
  }
  return invocation.run ? run_invocation(invocation) : EXIT_SUCCESS;
}
