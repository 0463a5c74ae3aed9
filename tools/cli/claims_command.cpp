#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/engine_options.h"
#include "tools/reproduce/claims.h"

namespace hoof::tools {

void add_claims_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<ClaimsOptions>();
  CLI::App* command = app.add_subcommand(
      "claims", "The paper's claims: supported, fragile or unsupported, with the runs behind it");
  std::vector<std::string> claims;
  for (const Claim& claim : paper_claims()) claims.push_back(claim.name);
  command->add_option("claim", options->names, "Which [all]; --list tells them")
      ->type_name("NAME")
      ->check(CLI::IsMember(claims).description(""));
  command
      ->add_option("--vary", options->variations,
                   "Only this variation besides the base; repeatable [all]")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(claim_variation_names()).description(""));
  add_ground_options(*command, options->ground);
  command->add_option("--beds", options->beds, "Bed preparations of each condition, 2..1000 [5]")
      ->type_name("N")
      ->check(CLI::Range(2, 1000));
  command->add_option("--seed", options->first_bed, "Of the first bed; the next count on [1]")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  add_engine_options(*command, options->engine);
  command->add_option("--set", options->settings, "Any setting, of every run")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command
      ->add_option("--out", options->out,
                   "Folder of the campaign, shared with hoof reproduce [runs/reproduce-BED]")
      ->type_name("DIR");
  command->add_flag("--plan", options->plan_only,
                    "Only list the runs, which are done, hours and disk of the others");
  command->add_flag("--no-runs", options->no_runs, "Judge by the runs that are there");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  auto list = std::make_shared<bool>(false);
  command->add_flag("--list", *list, "Only list claims and variations");
  command->footer(
      "Claims are judged over geometry, grain size and the calibrations that the paper's angle of\n"
      "repose cannot tell apart, on the same beds. Makes the runs that are missing, as hoof\n"
      "reproduce does: the same command goes on where it was.\n"
      "Examples:\n"
      "  hoof claims --list\n"
      "  hoof claims 30-best --plan\n"
      "  hoof claims 30-best --jobs 2\n"
      "  hoof claims --no-runs                          by what hoof reproduce has made\n"
      "  hoof claims spines-stiffen --vary fine-grains --vary coarse-grains --scale bench");
  command->callback([&invocation, options, list] {
    options->engine.quiet = options->quiet;
    options->engine.cluster.threads = options->engine.threads.value_or(1);
    invocation.run = [options, list] { *list ? list_claims() : judge_claims(*options); };
  });
}

}  // namespace hoof::tools
