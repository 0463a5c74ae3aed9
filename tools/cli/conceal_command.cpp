#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/conceal/examination.h"
#include "tools/conceal/grade.h"
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

void add_run(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<conceal::ExaminationOptions>();
  CLI::App* command = parent.add_subcommand("run", "Have a program diagnose each case of a batch");
  command->add_option("DIR", options->batch, "Folder of the batch")->required();
  command->add_option("--answers", options->answers, "Where the answers go, a folder for each case")
      ->type_name("DIR")
      ->required();
  command->add_option("--program", options->program, "Called as PROGRAM diagnose CASE --out DIR")
      ->type_name("PROGRAM")
      ->capture_default_str();
  command->add_option("--jobs", options->jobs, "Cases at once, 1..64")
      ->type_name("N")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--only", options->only, "This case alone")->type_name("CASE");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "Answers that are there stay: after Ctrl-C the same command goes on where it was.\n"
      "Example:\n"
      "  hoof conceal run runs/sealed --answers runs/answers --program build/release/tools/cli/hoof");
  command->callback(
      [&invocation, options] { invocation.run = [options] { conceal::examine(*options); }; });
}

void add_grade(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<conceal::GradeOptions>();
  CLI::App* command =
      parent.add_subcommand("grade", "Answers against the sealed truth, baselines beside them");
  command->add_option("DIR", options->batch, "Folder of the batch")->required();
  command->add_option("ANSWERS", options->answers, "Folder with one folder for each case")
      ->required();
  command->add_option("--truth", options->truth, "Where the truth is [DIR/truth.json]")
      ->type_name("FILE");
  command->add_option("--csv", options->csv, "Also write one line for each case")
      ->type_name("FILE");
  command->add_flag("--answered", options->answered,
                    "Leave out what has no answer folder yet, and say how many those are");
  command->footer(
      "Examples:\n"
      "  hoof conceal grade runs/sealed runs/answers\n"
      "  hoof conceal grade runs/sealed runs/answers --csv runs/graded.csv");
  command->callback([&invocation, options] {
    invocation.run = [options] { conceal::grade(*options, std::cout); };
  });
}

}  // namespace

void add_conceal_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command =
      app.add_subcommand("conceal", "The sealed blind test of hoof diagnose: make, run, grade");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof conceal make --seed 7 --count 40 --out runs/sealed\n"
      "  hoof conceal run runs/sealed --answers runs/answers\n"
      "  hoof conceal grade runs/sealed runs/answers");
  add_make(*command, invocation);
  add_run(*command, invocation);
  add_grade(*command, invocation);
}

}  // namespace hoof::tools
