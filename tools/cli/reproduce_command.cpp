#include <memory>

#include "tools/cli/commands.h"
#include "tools/reproduce/reproduce.h"

namespace hoof::tools {

void add_reproduce_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ReproduceOptions>();
  auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("reproduce", "The paper's sinkage and traction, its numbers beside ours");
  std::vector<std::string> known = {"all"};
  for (const auto& [name, part] : part_names()) known.push_back(name);
  command->add_option("what", *names, "all, load, opening, traction, traction-opening")
      ->type_name("WHAT")
      ->required()
      ->check(CLI::IsMember(known).description(""));
  command->add_option("--scale", options->scale, "Bed: demo (coarse grains), bench, paper [demo]")
      ->type_name("BED")
      ->check(CLI::IsMember({"demo", "bench", "paper"}).description(""));
  command
      ->add_option("--terrain", options->terrain,
                   "dem, or rft or rigid: quick looks that say nothing about sand [dem]")
      ->type_name("NAME")
      ->check(CLI::IsMember({"dem", "rft", "rigid"}).description(""));
  command->add_flag_callback(
      "--full", [options] { options->design = Design::kFull; },
      "Every load from 10 to 60 kg; else the conditions that the paper states numbers of");
  command->add_option("--beds", options->beds, "Bed preparations of each condition, 1..1000 [5]")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", options->first_bed, "Of the first bed; the next count on [1]")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--threads", options->threads, "Threads of the sand solver, 1..1024")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--set", options->settings,
                   "Any setting, of every run, e.g. --set experiment.time_limit_s=0.5")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Folder of the campaign [runs/reproduce-BED]")
      ->type_name("DIR");
  command->add_flag("--plan", options->plan_only, "Only list the runs, and which are done");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "Runs what is missing and reuses what is there: after Ctrl-C, a crash or a power cut the "
      "same\n"
      "command goes on where it was. Writes summary.csv, summary.json and report.html after each\n"
      "run. Exit status 3 where runs could not be finished.\n"
      "Examples:\n"
      "  hoof reproduce all --plan\n"
      "  hoof reproduce load --beds 5 --threads 2\n"
      "  hoof reproduce opening --scale bench --beds 5 --out runs/opening\n"
      "  hoof reproduce all --terrain rft --beds 1      the chain in minutes, without grains");
  command->callback([&invocation, options, names] {
    for (const std::string& name : *names) {
      for (const auto& [known_name, part] : part_names()) {
        if (name == known_name) options->parts.insert(part);
      }
      if (name == "all") {
        for (const auto& [known_name, part] : part_names()) options->parts.insert(part);
      }
    }
    invocation.run = [options] { reproduce(*options); };
  });
}

}  // namespace hoof::tools
