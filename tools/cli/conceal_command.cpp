#include <memory>

#include "tools/cli/commands.h"
#include "tools/conceal/make.h"

namespace hoof::tools {
namespace {

void add_make(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<conceal::MakeOptions>();
  CLI::App* command = parent.add_subcommand("make", "Draw cases and seal the truth about them");
  command->add_option("--seed", options->seed, "Of all that is drawn")
      ->type_name("S")
      ->capture_default_str();
  command->add_option("--count", options->count, "Cases, 1..9999")
      ->type_name("N")
      ->check(CLI::Range(1, 9999))
      ->capture_default_str();
  command->add_option("--out", options->out, "New folder of the batch")
      ->type_name("DIR")
      ->required();
  command->add_option("--truth", options->truth, "Where the truth goes [DIR/truth.json]")
      ->type_name("FILE");
  command->add_option("--rig", options->rig, "servo_pendulum, plate_sand or all: four to one")
      ->type_name("NAME")
      ->check(CLI::IsMember({"servo_pendulum", "plate_sand", "all"}))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Cases made at once, 1..64")
      ->type_name("N")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "Examples:\n"
      "  hoof conceal make --seed 7 --count 40 --out runs/sealed\n"
      "  hoof conceal make --seed 7 --count 400 --out runs/sealed --truth truth-of-7.json");
  command->callback(
      [&invocation, options] { invocation.run = [options] { conceal::make(*options); }; });
}

}  // namespace

void add_conceal_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("conceal", "The sealed blind test of hoof diagnose: make, run, grade");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof conceal make --seed 7 --count 40 --out runs/sealed");
  add_make(*command, invocation);
}

}  // namespace hoof::tools
