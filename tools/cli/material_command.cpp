#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/materials/material_shelf.h"
#include "tools/materials/starting_card.h"
#include "tools/materials/starting_text.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

struct SuggestOptions {
  StartingRequest request;
  double d50_mm = 0;
  std::filesystem::path heaps;  // empty: the stored ones
  std::filesystem::path out;
  std::string name;
};

/// The command that gives the same card.
std::string command_of(const SuggestOptions& o) {
  const StartingRequest& r = o.request;
  return "hoof material suggest --bulk-density " + format_number(r.bulk_density_kg_m3) +
         " --repose " + format_number(r.repose_deg) + " --tolerance " +
         format_number(r.tolerance_deg) + (r.d50_m ? " --d50 " + format_number(o.d50_mm) : "");
}

void suggest(SuggestOptions options) {
  StartingRequest& request = options.request;
  if (options.d50_mm > 0) request.d50_m = 1e-3 * options.d50_mm;
  request.validate();
  const Shelf shelf = read_shelf();
  const ReposeSurface ours = surface_of_heaps(
      options.heaps.empty() ? default_materials_dir() / "repose_heaps.csv" : options.heaps);
  const ReposeSurface paper = surface_of_paper();
  const StartingRange by_ours = starting_range(ours, request, usual_doubts(ours));
  std::cout << density_text(request) << "\n"
            << range_text(ours, request, by_ours) << "\n"
            << range_text(paper, request, starting_range(paper, request, usual_doubts(paper)))
            << "\n"
            << alike_text(shelf, request)
            << "\nA starting range, not a calibration: one angle does not tell three coefficients, "
               "and the height of\nfall and the funnel make the angle as well "
               "(tools/calibrate/README.md).\n";
  if (options.out.empty()) return;
  const std::string name = options.name.empty() ? options.out.stem().string() : options.name;
  write_file(options.out, starting_card(name, command_of(options), ours, request, by_ours));
  std::cout << "\n"
            << options.out.string() << ": hoof sinkage --set use.materials=" << options.out.string()
            << "\n";
}

void add_suggest(CLI::App& parent, Invocation& invocation) {
  auto o = std::make_shared<SuggestOptions>();
  CLI::App* command = parent.add_subcommand(
      "suggest", "Starting ranges of the coefficients from a bulk density and an angle of repose");
  command->add_option("--bulk-density", o->request.bulk_density_kg_m3, "As poured, 300..5000")
      ->type_name("KG_PER_M3")
      ->required();
  command->add_option("--repose", o->request.repose_deg, "Angle of repose, 1..89")
      ->type_name("DEG")
      ->required();
  command->add_option("--tolerance", o->request.tolerance_deg, "Of the angle, 0.05..10 [1]")
      ->type_name("DEG");
  command->add_option("--d50", o->d50_mm, "Of your sand, to tell how it scales")
      ->type_name("MM")
      ->check(CLI::Range(0.001, 100.0));
  command
      ->add_option("--heaps", o->heaps,
                   "Another design.csv of hoof calibrate repose --full [the stored heaps]")
      ->type_name("DESIGN.csv")
      ->check(CLI::ExistingFile);
  command->add_option("--out", o->out, "A material file with the middle of the set and its ranges")
      ->type_name("FILE.toml");
  command->add_option("--name", o->name, "Of that card [the file's]")->type_name("NAME");
  command->footer(
      "Examples:\n"
      "  hoof material suggest --bulk-density 1550 --repose 33\n"
      "  hoof material suggest --bulk-density 1550 --repose 33 --d50 0.4 --out my-sand.toml\n"
      "  hoof sinkage --set use.materials=my-sand.toml");
  command->callback([&invocation, o] { invocation.run = [o] { suggest(*o); }; });
}

}  // namespace

void add_material_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("material", "Sands with their sources, and where to begin with another");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof material list\n"
      "  hoof material show paper\n"
      "  hoof material suggest --bulk-density 1550 --repose 33");
  CLI::App* list = command->add_subcommand("list", "All sands, in a table");
  list->footer("Example:\n  hoof material list");
  list->callback([&invocation] { invocation.run = [] { std::cout << shelf_text(read_shelf()); }; });
  auto name = std::make_shared<std::string>();
  CLI::App* show = command->add_subcommand("show", "One card: every value's range and source");
  show->add_option("name", *name, "A card, or a material file")->type_name("NAME|FILE")->required();
  show->footer(
      "Examples:\n"
      "  hoof material show grc-1\n"
      "  hoof material show my-sand.toml");
  show->callback([&invocation, name] {
    invocation.run = [name] { std::cout << card_text(read_shelf(), *name); };
  });
  add_suggest(*command, invocation);
}

}  // namespace hoof::tools
