#include <algorithm>
#include <map>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/engine_options.h"
#include "tools/reproduce/paper_numbers.h"
#include "tools/reproduce/reproduce.h"
#include "tools/reproduce/variation.h"

namespace hoof::tools {

void add_reproduce_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReproduceOptions>();
  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("reproduce", "The paper's experiments, its numbers beside ours");
  std::vector<std::string> known = {"all"};
  for (const auto& [name, part] : part_names()) known.push_back(name);
  for (const std::string& number : paper_numbers()) known.push_back(number);
  command
      ->add_option("what", *names,
                   "all, load, opening, traction, traction-opening, table2..table5; fig5..fig29 "
                   "tell what is known of them")
      ->type_name("WHAT")
      ->required()
      ->check(CLI::IsMember(known).description(""));
  add_ground_options(*command, options->ground);
  std::map<std::string, Design> designs(design_names().begin(), design_names().end());
  command
      ->add_option(
          "--design", options->asked,
          "night: 16 conditions, for fine grains on two cores; stated: the 44 that the paper "
          "states numbers of; full: every load, 98 [night on bench, else stated]")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(designs).description(""));
  command->add_flag_callback(
      "--full", [options] { options->asked = Design::kFull; }, "The same as --design full");
  command->add_option("--beds", options->beds, "Bed preparations of each condition, 1..1000 [5]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", options->first_bed, "Of the first bed; the next count on [1]")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  std::vector<std::string> variations = {"all"};
  variations.insert(variations.end(), variation_names().begin(), variation_names().end());
  command
      ->add_option("--vary", options->variations,
                   "Makes the runs with this changed too, so that the summary tells why a number "
                   "is not the paper's; repeatable; all; hoof claims --list tells them")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(variations).description(""));
  command
      ->add_option("--vary-beds", options->variation_beds, "Beds of these, the first of --beds [2]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--reasons-from", options->reasons_from,
                   "Folder of another campaign, as of coarser grains where changes are cheap: what "
                   "it found of a target that is outside here stands beside it")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
  add_engine_options(*command, options->engine);
  command
      ->add_option("--set", options->settings,
                   "Any setting, of every run, e.g. --set experiment.time_limit_s=0.5")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--out", options->out,
                   "Folder of the campaign, shared with hoof claims [runs/reproduce-BED]")
      ->type_name("DIR");
  command->add_flag("--plan", options->plan_only,
                    "Only list the runs, which are done, hours and disk of the others");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "Runs what is missing and reuses what is there: after Ctrl-C, a crash or a power cut the "
      "same\n"
      "command goes on where it was. Writes summary.csv, summary.json, figures/*.svg and "
      "report.html\n"
      "after each run. Exit status 3 where runs could not be finished. `all` makes the tables "
      "too,\n"
      "on grains. With --engine slurm the folder and this program must be seen by all nodes.\n"
      "Examples:\n"
      "  hoof reproduce all --plan\n"
      "  hoof reproduce load --beds 5 --jobs 2\n"
      "  hoof reproduce table3 table5\n"
      "  hoof reproduce load opening --vary all --vary-beds 1   why a number is not the paper's\n"
      "  hoof reproduce all --scale bench                     a night of two cores\n"
      "  hoof reproduce all --scale bench --reasons-from runs/reproduce-medium   with what --vary "
      "found there\n"
      "  hoof reproduce all --full --scale paper --engine slurm --at-once 64 --time 24:00:00 "
      "--wait\n"
      "  hoof reproduce all --terrain rft --beds 1      the chain in minutes, without grains");
  command->callback([&invocation, options, names] {
    for (const std::string& name : *names) {
      const bool all = name == "all";
      for (const auto& [known_name, part] : part_names()) {
        if (all || name == known_name) options->parts.insert(part);
      }
      // The tables are of grains: no part of a quick look without them.
      for (const std::string& number : paper_numbers()) {
        const bool wanted =
            all ? is_paper_table(number) && options->ground.terrain == "dem" : name == number;
        if (!wanted) continue;
        (is_paper_table(number) ? options->tables : options->figures).push_back(number);
      }
    }
    if (std::count(options->variations.begin(), options->variations.end(), "all") > 0) {
      options->variations = variation_names();
    }
    options->engine.quiet = options->quiet;
    options->engine.cluster.threads = options->engine.threads.value_or(1);
    invocation.run = [options] { reproduce(*options); };
  });
}

}  // namespace hoof::tools
