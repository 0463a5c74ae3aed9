#include "tools/cli/run_options.h"

namespace hoof::tools {
namespace {

std::string check_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0) return "";
  return "'" + text + "' is not of the form key=value, e.g. bed.depth_mm=100";
}

}  // namespace

void add_run_options(CLI::App& command, RunOptions& options) {
  command.add_option("--out", options.out, "Folder of the run [runs/<experiment>-<date>-<n>]")
      ->type_name("DIR");
  command.add_flag("--force", options.force, "Replace an earlier run folder of the same name");
  command.add_option("--seed", options.seed, "Seed of everything random")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  // 1024: a bound against slips of the finger; no machine in sight has more.
  command.add_option("--threads", options.threads, "Threads of the sand solver, 1..1024")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--set", options.settings,
                  "Any setting of the TOML files, e.g. --set bed.depth_mm=100; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->check(CLI::Validator(check_setting, ""));
  command.add_flag("--live", options.live, "Send the telemetry over LCM while running");
  command.add_flag("--quiet", options.quiet, "Show no progress");
}

void add_effect_options(CLI::App& command, std::string& effects, std::filesystem::path& conceal) {
  CLI::Option* file =
      command
          .add_option("--effects", effects,
                      "Physics beyond the nominal plant: TOML, as hoof diagnose's improved.toml")
          ->type_name("FILE")
          ->check(CLI::ExistingFile);
  command
      .add_option("--conceal", conceal,
                  "Leave the effects, and what no bench measures, out of the run's folder; tell "
                  "them in FILE only")
      ->type_name("FILE")
      ->needs(file);
}

}  // namespace hoof::tools
