// The program behind tools/hoof: parses the command line, runs one command, and turns every
// failure into one line on standard error and an exit status (tools/run/errors.h).

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <string>

#include "tools/cli/commands.h"
#include "tools/cli/exit_status.h"
#include "tools/cli/invocation.h"
#include "tools/run/errors.h"
#include "tools/trajectory/trajectory_command.h"

namespace {

using namespace hoof::tools;

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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Firmware of a goat-like foot in a bed of grains: tests, runs and reports.");
  app.name("hoof");
  app.footer(
      "tools/hoof test [--full] [ctest arguments] builds and runs all tests.\n"
      "tools/hoof benchmark dem|boundary|terrain|lockstep|soak|trajectory|cost|firmware measures "
      "speed.\n"
      "tools/hoof firmware build|size|flash makes, measures and flashes the board's image.\n"
      "tools/hoof bridge is the plant alone on a CAN bus; firmware run, the firmware alone.\n"
      "hoof COMMAND --help shows a command's flags and examples.");
  app.require_subcommand(1);

  Invocation invocation;
  add_sinkage_command(app, invocation);
  add_traction_command(app, invocation);
  add_reproduce_command(app, invocation);
  add_claims_command(app, invocation);
  add_campaign_command(app, invocation);
  add_study_command(app, invocation);
  add_terrain_command(app, invocation);
  add_bed_command(app, invocation);
  add_order_command(app, invocation);
  add_param_command(app, invocation);
  add_faults_command(app, invocation);
  add_dbc_command(app, invocation);
  add_trajectory_command(app);
  add_report_command(app, invocation);
  add_firmware_command(app, invocation);
  add_log_command(app, invocation);
  add_replay_command(app, invocation);
  add_compare_command(app, invocation);
  add_diagnose_command(app, invocation);
  add_simulate_command(app, invocation);
  add_material_command(app, invocation);
  add_design_command(app, invocation);
  add_anova_command(app, invocation);
  add_calibrate_command(app, invocation);
  add_conceal_command(app, invocation);
  add_version_command(app, invocation);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::RuntimeError& done) {
    return done.get_exit_code();  // a command that has said itself what is wrong
  } catch (const CLI::ParseError& error) {
    return complain("hoof", explain(app, error, argc, argv), ExitStatus::kUserError);
  }
  return invocation.run ? run_to_status("hoof", invocation.run) : EXIT_SUCCESS;
}
