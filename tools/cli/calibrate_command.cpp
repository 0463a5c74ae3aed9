#include <memory>
#include <numbers>

#include "tools/calibrate/calibrate.h"
#include "tools/cli/commands.h"

namespace hoof::tools {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kDegree = std::numbers::pi / 180;

/// A flag in another unit than the setting's. The laboratories name what is out of bounds.
CLI::Option* scaled(CLI::App& command, const std::string& flag, double& into, double unit,
                    const std::string& help, const std::string& type) {
  return command
      .add_option_function<double>(
          flag, [&into, unit](double value) { into = value * unit; }, help)
      ->type_name(type);
}

void add_common(CLI::App& command, CalibrateOptions& options, const std::string& laboratory,
                const std::string& pair) {
  command
      .add_option("--material", options.material,
                  "A material file like sim/config/materials/paper.toml [that one]")
      ->type_name("FILE.toml")
      ->check(CLI::ExistingFile);
  // The bounds of the material files.
  command.add_option("--e", options.flags.restitution, "Restitution, " + pair)
      ->type_name("E")
      ->check(CLI::Range(0.01, 1.0));
  command.add_option("--mu-s", options.flags.static_friction, "Static friction, " + pair)
      ->type_name("MU")
      ->check(CLI::Range(0.0, 5.0));
  command.add_option("--mu-r", options.flags.rolling_friction, "Rolling friction, " + pair)
      ->type_name("MU")
      ->check(CLI::Range(0.0, 5.0));
  command
      .add_option(
          "--out", options.out,
          "Folder for result.json, runs.csv, report.html [runs/calibrate-" + laboratory + "]")
      ->type_name("DIR");
  command.add_flag("--quiet", options.quiet, "Show no progress");
}

void add_check(CLI::App& command, CheckSettings& check) {
  command.add_option("--grains", check.grains, "Grains of the check, 1..10000 [75]")
      ->type_name("N")
      ->check(CLI::Range(1, 10000));
  scaled(command, "--spread", check.spread_m, kMillimetre,
         "Their places of release: within +- this [1]", "MM");
  scaled(command, "--bin", check.bin_m, kMillimetre, "Width of the bins of the weighted mean [4]",
         "MM")
      ->check(CLI::Range(0.01, 100.0));
  command.add_option("--seed", check.seed, "Of the places of release [1]")->type_name("S");
}

void add_restitution(CLI::App& parent, Invocation& invocation) {
  struct Options {
    CalibrateOptions common;
    RestitutionSettings lab;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(
      "restitution", "Drop on an inclined plate: travel L over e (table 3), and e of a measured L");
  add_common(*command, o->common, "restitution", "grain on plate");
  add_check(*command, o->lab.check);
  CLI::Option* before = scaled(*command, "--height", o->lab.test.height_m, kMillimetre,
                               "Fall onto the plate [40.42]", "MM");
  CLI::Option* after = scaled(*command, "--height-after", o->lab.test.height_after_m, kMillimetre,
                              "Fall after the impact [as --height]", "MM");
  scaled(*command, "--plate", o->lab.test.plate_rad, kDegree, "Of the plate [45]", "DEG");
  command->footer(
      "Examples:\n"
      "  hoof calibrate restitution\n"
      "  hoof calibrate restitution --height 24.3 --height-after 70.9 --out runs/two-heights");
  command->callback([&invocation, o, before, after] {
    if (before->count() > 0 && after->count() == 0) {
      o->lab.test.height_after_m = o->lab.test.height_m;
    }
    invocation.run = [o] { calibrate_restitution(o->common, o->lab); };
  });
}

void add_rolling(CLI::App& parent, Invocation& invocation) {
  struct Options {
    CalibrateOptions common;
    RollingSettings lab;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(
      "rolling", "Incline and flight: travel S2 over mu_r (table 5), and mu_r of a measured S2");
  add_common(*command, o->common, "rolling", "grain on plate");
  add_check(*command, o->lab.check);
  scaled(*command, "--incline", o->lab.test.incline_rad, kDegree, "To the horizontal [45]", "DEG");
  scaled(*command, "--run", o->lab.test.run_m, kMillimetre,
         "Way rolled along the incline, S1 [49.6]", "MM");
  scaled(*command, "--fall", o->lab.test.fall_m, kMillimetre, "Edge over the ground, H4 [64.3]",
         "MM");
  command->footer(
      "Examples:\n"
      "  hoof calibrate rolling\n"
      "  hoof calibrate rolling --run 35.4     the run that the paper's balance would need");
  command->callback(
      [&invocation, o] { invocation.run = [o] { calibrate_rolling(o->common, o->lab); }; });
}

void add_sliding(CLI::App& parent, Invocation& invocation) {
  struct Options {
    CalibrateOptions common;
    SlidingSettings lab;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(
      "sliding", "Tilting plate: angle over mu_s (table 4), and mu_s of a measured angle");
  add_common(*command, o->common, "sliding", "grain on plate");
  command->add_option("--grains", o->lab.grains, "Grains of the check, 1..10000 [75]")
      ->type_name("N")
      ->check(CLI::Range(1, 10000));
  scaled(*command, "--rate", o->lab.test.rate_rad_s, kDegree, "Of the tilting [2]", "DEG_PER_S");
  scaled(*command, "--seen", o->lab.test.seen_m, kMillimetre, "A slide that is seen [0.1]", "MM");
  command->footer(
      "Examples:\n"
      "  hoof calibrate sliding\n"
      "  hoof calibrate sliding --rate 0.2 --seen 0.01     slower and looked at closely");
  command->callback(
      [&invocation, o] { invocation.run = [o] { calibrate_sliding(o->common, o->lab); }; });
}

void add_repose(CLI::App& parent, Invocation& invocation) {
  struct Options {
    CalibrateOptions common;
    ReposeSettings lab;
    int threads = 2;
  };
  auto o = std::make_shared<Options>();
  CLI::App* command = parent.add_subcommand(
      "repose", "Funnel and heap: angle of repose against 37.8 degrees; --full: table 2 as well");
  add_common(*command, o->common, "repose", "grain on grain");
  command->add_option("--grains", o->lab.test.grains, "In each heap, 100..200000 [3000]")
      ->type_name("N");
  command->add_option("--seeds", o->lab.seeds, "Heaps, 1..1000 [5]")->type_name("N");
  command->add_option("--seed", o->lab.test.seed, "Of the first heap; the next count on [1]")
      ->type_name("S");
  scaled(*command, "--outlet", o->lab.test.outlet_m, kMillimetre, "Of the funnel, diameter [36]",
         "MM");
  scaled(*command, "--rim", o->lab.test.rim, 1,
         "Of a dish in place of the wide plate, its height over d50 [0: the plate]", "X");
  scaled(*command, "--overflow", o->lab.test.overflow, 1,
         "With --rim: sand poured over what a heap of 38 degrees on the dish holds [2]", "X");
  scaled(*command, "--drop", o->lab.test.drop, 1,
         "Height of the outlet over that of the tip of a heap of 55 degrees [1.8]", "X");
  scaled(*command, "--step", o->lab.test.step_s, 1e-6, "Time step [5.6]", "US");
  command->add_option("--threads", o->threads, "Heaps at once, 1..1024; the bytes are the same [2]")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--full", o->lab.table2,
                    "Also the 13 combinations of table 2, as many heaps of each");
  command->footer(
      "Heaps are kept: after Ctrl-C the same command goes on where it was.\n"
      "Examples:\n"
      "  hoof calibrate repose\n"
      "  hoof calibrate repose --mu-r 0.25 --seeds 3 --out runs/less-rolling\n"
      "  hoof calibrate repose --rim 1 --out runs/dish     the foot held by a rim\n"
      "  hoof calibrate repose --full --seeds 2      table 2, half an hour of a core");
  command->callback([&invocation, o] {
    invocation.run = [o] { calibrate_repose(o->common, o->lab, o->threads); };
  });
}

}  // namespace

void add_calibrate_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "Virtual laboratories for contact coefficients, against the source paper's");
  command->require_subcommand(1);
  command->footer(
      "Each runs grains in the engine of the sand and prints its targets, the paper's analysis\n"
      "beside the right one.\n"
      "Examples:\n"
      "  hoof calibrate restitution\n"
      "  hoof calibrate rolling\n"
      "  hoof calibrate sliding\n"
      "  hoof calibrate repose --threads 2           minutes");
  add_restitution(*command, invocation);
  add_rolling(*command, invocation);
  add_sliding(*command, invocation);
  add_repose(*command, invocation);
}

}  // namespace hoof::tools
