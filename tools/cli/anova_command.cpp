#include <iostream>
#include <map>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/design_of_experiments/anova_report.h"

namespace hoof::tools {

void add_anova_command(CLI::App& app, Invocation& invocation) {
  auto options = std::make_shared<AnovaOptions>();
  CLI::App* command =
      app.add_subcommand("anova", "A response surface of runs that were made, and its variance");
  command->add_option("data", options->data, "Runs, one in each row")
      ->type_name("DATA.csv")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("--factors", options->factors, "Columns that were varied")
      ->type_name("A,B,...")
      ->delimiter(',')
      ->required();
  command->add_option("--response", options->response, "Column of what came out")
      ->type_name("NAME")
      ->required();
  command->add_option("--range", options->ranges, "Bounds of a factor [those of the data]")
      ->type_name("NAME=LOW:HIGH")
      ->allow_extra_args(false);
  static const std::map<std::string, SurfaceModel> kModels = {
      {"linear", SurfaceModel::kLinear},
      {"interactions", SurfaceModel::kInteractions},
      {"quadratic", SurfaceModel::kQuadratic}};
  command->add_option("--model", options->model, "linear, interactions or quadratic [quadratic]")
      ->type_name("NAME")
      ->transform(CLI::CheckedTransformer(kModels).description(""));
  command->add_flag("--smallest", options->smallest, "The optimum is the smallest response");
  CLI::Option* target =
      command->add_option("--target", options->target, "A measured response: what may have made it")
          ->type_name("Y");
  command->add_option("--tolerance", options->tolerance, "Of the target, in its unit")
      ->type_name("DY")
      ->check(CLI::PositiveNumber)
      ->needs(target);
  target->needs(command->get_option("--tolerance"));
  command
      ->add_option("--second", options->doubts,
                   "Doubt that a second test of one factor would leave [5 % of its range]")
      ->type_name("NAME=DOUBT")
      ->allow_extra_args(false)
      ->needs(target);
  command->add_option("--out", options->out, "Folder for anova.json, predicted.csv, valley.csv")
      ->type_name("DIR");
  command->footer(
      "Partial sums of squares in coded factors; lack of fit against repeated runs.\n"
      "Examples (the source paper's table 2):\n"
      "  hoof anova tests/data/paper/table2.csv --factors e,mu_r,mu_s --response repose_deg\n"
      "  hoof anova tests/data/paper/table2.csv --factors e,mu_r,mu_s --response repose_deg \\\n"
      "    --target 37.8 --tolerance 0.45 --second e=0.02 --second mu_s=0.01 --out runs/anova");
  command->callback([&invocation, options, target] {
    options->has_target = target->count() > 0;
    invocation.run = [options] { std::cout << run_anova(*options); };
  });
}

}  // namespace hoof::tools
