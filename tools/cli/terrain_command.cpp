#include <memory>

#include "tools/cli/commands.h"
#include "tools/terrain/fit_terrain.h"

namespace hoof::tools {
namespace {

void add_fit(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<FitTerrainOptions>();
  CLI::App* command =
      parent.add_subcommand("fit", "Push plates into grains, fit a fast soil, print its error");
  CLI::Option* from =
      command->add_option("--from", options->from, "Fit to these pushes and move no sand")
          ->type_name("PUSHES.csv")
          ->check(CLI::ExistingFile);
  const auto of_sand = [&](CLI::Option* option) { return option->excludes(from); };
  of_sand(
      command->add_option("--bed", options->bed.bed, "demo, medium, bench, paper, or a TOML file [demo]"))
      ->type_name("NAME|FILE.toml");
  of_sand(command->add_option("--seed", options->bed.seed, "Of the bed"))
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  of_sand(command->add_option("--threads", options->bed.threads, "Of the sand solver, 1..1024"))
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  of_sand(command->add_option("--speed", options->speed_m_s, "Of the plates, 0.01..1 m/s [0.3]"))
      ->type_name("M_PER_S")
      ->check(CLI::Range(0.01, 1.0));
  of_sand(command->add_option("--scale", options->scale, "Size of the plates, 0.05..5 [1]"))
      ->type_name("X")
      ->check(CLI::Range(0.05, 5.0));
  of_sand(command->add_option("--set", options->bed.settings,
                              "Any setting of bed or materials, e.g. --set bed.depth_mm=100"))
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--law", options->law, "Pressure over depth: linear (3D-RFT's own) or bekker")
      ->type_name("linear|bekker")
      ->check(CLI::IsMember({"linear", "bekker"}))
      ->capture_default_str();
  command->add_option("--start", options->start, "Soil that gives the numbers not fitted")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  command->add_option("--out", options->out, "Folder for pushes.csv and soil.toml")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "15 pushes, a third of them held out. Finished ones are kept: after Ctrl-C the same command\n"
      "goes on where it was.\n"
      "Examples:\n"
      "  hoof terrain fit --threads 2                    coarse grains, minutes\n"
      "  hoof terrain fit --law bekker --from runs/terrain-fit/pushes.csv --out runs/bekker\n"
      "  hoof terrain fit --bed bench --scale 0.4 --out runs/bench-soil\n"
      "  hoof sinkage --terrain rft --soil runs/terrain-fit/soil.toml");
  command->callback(
      [&invocation, options] { invocation.run = [options] { fit_terrain(*options); }; });
}

void add_show(CLI::App& parent, Invocation& invocation) {
  struct Lengths {
    ShowTerrainOptions show;
    std::vector<double> plate_mm = {100, 60};
    double depth_mm = 30;
  };
  auto options = std::make_shared<Lengths>();
  CLI::App* command =
      parent.add_subcommand("show", "Pressure and force of a flat plate over depth");
  command->add_option("--soil", options->show.soil, "demo, or a file of hoof terrain fit")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  command->add_option("--plate", options->plate_mm, "Length and width [100,60]")
      ->type_name("L,W (mm)")
      ->delimiter(',')
      ->expected(2)
      ->check(CLI::Range(1.0, 1000.0));
  command->add_option("--depth", options->depth_mm, "Greatest depth [30]")
      ->type_name("MM")
      ->check(CLI::Range(0.1, 1000.0));
  command->footer("Example:\n  hoof terrain show --plate 175,40 --depth 20");
  command->callback([&invocation, options] {
    options->show.length_m = options->plate_mm[0] * 1e-3;
    options->show.width_m = options->plate_mm[1] * 1e-3;
    options->show.depth_m = options->depth_mm * 1e-3;
    invocation.run = [options] { show_terrain(options->show); };
  });
}

}  // namespace

void add_terrain_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("terrain", "Fast soils: fitted to pushes into grains, and shown");
  command->footer(
      "Examples:\n"
      "  hoof terrain fit --threads 2\n"
      "  hoof terrain show --soil runs/terrain-fit/soil.toml");
  command->require_subcommand(1);
  add_fit(*command, invocation);
  add_show(*command, invocation);
}

}  // namespace hoof::tools
