#include <iostream>
#include <memory>

#include "sim/terrain/bed_report.h"
#include "tools/bed/bed_source.h"
#include "tools/bed/bed_text.h"
#include "tools/bed/export_bed.h"
#include "tools/bed/make_bed.h"
#include "tools/cli/commands.h"

namespace hoof::tools {
namespace {

/// Flags that choose a bed's settings, for a command that makes or finds one by them.
void add_settings_flags(CLI::App& command, BedOptions& options) {
  command.add_option("--seed", options.seed, "Seed of the places the grains fall from")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--periodic", options.periodic, "No side walls: sides that meet each other");
  command
      .add_option("--sieve", options.sieve,
                  "Sieve analysis in place of the bed's own: aperture_mm,passing_percent or "
                  "aperture_mm,retained_percent")
      ->type_name("FILE.csv");
  command.add_option("--sieve-range", options.sieve_range_mm, "Part of the analysis that is used")
      ->type_name("FROM,TO (mm)")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--sieve-scale", options.sieve_scale, "Grains are this many times as large")
      ->type_name("X")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--set", options.settings,
                  "Any setting of the bed or the materials, e.g. --set bed.depth_mm=100")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_make(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<MakeBedOptions>();
  CLI::App* command = parent.add_subcommand("make", "Pour, settle and level a bed");
  command->add_option("--bed", options->bed.bed, "demo, medium, bench, paper, or a TOML file")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  add_settings_flags(*command, options->bed);
  // 1024: a bound against slips of the finger; no machine in sight has more.
  command->add_option("--threads", options->bed.threads, "Threads of the sand solver, 1..1024")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", options->out, "Bed file [where runs look for it]")
      ->type_name("FILE");
  command->add_flag("--force", options->force, "Make it again even if it is there");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command
      ->add_option("--checkpoint-every", options->checkpoint_every_min,
                   "Minutes between checkpoints, from which the same command goes on")
      ->type_name("MIN")
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  command->footer(
      "Examples:\n"
      "  hoof bed make --bed bench --threads 2\n"
      "  hoof bed make --bed bench --periodic --set bed.depth_mm=60 --out bench-60.bed\n"
      "  hoof bed make --bed bench --sieve sim/config/beds/paper-sieve.csv --sieve-range 0.5,1.6 "
      "--sieve-scale 4");
  command->callback([&invocation, options] { invocation.run = [options] { make_bed(*options); }; });
}

void add_info(CLI::App& parent, Invocation& invocation) {
  struct InfoOptions {
    BedOptions bed;
    bool json = false;
  };
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = parent.add_subcommand("info", "What a bed that was made is like");
  command
      ->add_option("BED", options->bed.bed, "A bed file, or demo, medium, bench, paper, FILE.toml")
      ->required();
  add_settings_flags(*command, options->bed);
  command->add_flag("--json", options->json, "One JSON object, SI units");
  command->footer("Examples:\n  hoof bed info demo\n  hoof bed info bench-60.bed --json");
  command->callback([&invocation, options] {
    invocation.run = [options] {
      const OpenedBed bed = open_bed(options->bed);
      const sim::BedReport report =
          sim::inspect_bed(bed.origin.bed, bed.origin.materials, bed.state);
      if (options->json) {
        std::cout << bed_json(bed.origin, report).dump(2) << "\n";
      } else {
        std::cout << bed_text(bed.origin, report);
      }
    };
  });
}

void add_export(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<ExportBedOptions>();
  CLI::App* command =
      parent.add_subcommand("export", "Grains, contacts and a foot for ParaView, or a table");
  command
      ->add_option("BED", options->bed.bed, "A bed file, or demo, medium, bench, paper, FILE.toml")
      ->required();
  add_settings_flags(*command, options->bed);
  command->add_option("--csv", options->csv, "Table of the grains, SI units")->type_name("FILE");
  command
      ->add_option("--vtk", options->vtk,
                   "Folder for bed.pvd and its .vtp files; arrays named as those of LIGGGHTS")
      ->type_name("DIR");
  command->add_option("--region", options->region_mm, "Only grains with their centres in this box")
      ->type_name("X0,X1,Y0,Y1,Z0,Z1 (mm)")
      ->delimiter(',')
      ->expected(6);
  command->add_option("--every", options->every, "Only every Nth grain")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  CLI::Option* foot = command->add_option("--foot", options->foot, "Foot to show over the sand")
                          ->type_name("NAME|FILE.stl");
  command->add_option("--foot-height", options->foot_height_mm, "Height of its sole above the sand")
      ->type_name("MM")
      ->needs(foot);
  command->add_option("--toe", options->toe_deg, "Opening of each of its toes, degrees")
      ->type_name("DEG")
      ->check(CLI::Range(0.0, 40.0))
      ->needs(foot);
  command->footer(
      "Examples:\n"
      "  hoof bed export demo --vtk demo-vtk --foot bionic --foot-height 5\n"
      "  hoof bed export bench-60.bed --csv slice.csv --region -160,160,-2,2,-60,0");
  command->callback(
      [&invocation, options] { invocation.run = [options] { export_bed(*options); }; });
}

}  // namespace

void add_bed_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand("bed", "Make, describe and export beds of sand");
  command->footer(
      "Examples:\n"
      "  hoof bed make --bed bench --seed 3\n"
      "  hoof bed info demo\n"
      "  hoof bed export demo --vtk out");
  command->require_subcommand(1);
  add_make(*command, invocation);
  add_info(*command, invocation);
  add_export(*command, invocation);
}

}  // namespace hoof::tools
