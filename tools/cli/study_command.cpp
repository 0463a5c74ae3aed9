#include <functional>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/fault_matrix.h"
#include "tools/study/drop_law.h"
#include "tools/study/foot_proof.h"
#include "tools/study/grains_check.h"
#include "tools/study/study.h"

namespace hoof::tools {
namespace {

using Study = void (*)(const StudyOptions&);

CLI::App* add_study(CLI::App& parent, Invocation& invocation, const char* name, const char* help,
                    Study study) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* command = parent.add_subcommand(name, help);
  command->add_flag("--full", options->full, "The long form: more grain sizes, boxes and bodies");
  command->add_option("--beds", options->bed_count, "Beds of each kind, one seed each, 1..1000")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", options->seed, "Seed of the first bed; the next count on")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--scales", options->scales, "Grain diameters over the paper's, e.g. 3.6,2.1")
      ->type_name("X,...")
      ->delimiter(',')
      ->check(CLI::Range(0.2, 20.0));
  command->add_option("--threads", options->threads, "Threads of the sand solver, 1..1024")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", options->out, "Folder of the study [runs/study-NAME]")
      ->type_name("DIR");
  command->add_option("--bed-folder", options->beds, "Where settled beds are kept")
      ->type_name("DIR");
  command
      ->add_option("--set", options->settings,
                   "Any setting of a sinkage run, e.g. --set bed.steps_per_ms=180")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->callback(
      [&invocation, options, study] { invocation.run = [options, study] { study(*options); }; });
  command->footer(
      "Finished cases are kept: after Ctrl-C the same command goes on where it was.\n"
      "Example:\n  hoof study " +
      std::string(name) + " --beds 5 --threads 1");
  // For the flags that only some studies have.
  const auto list = [&](const char* flag, auto& into, const char* text, const char* type) {
    return command->add_option(flag, into, text)->type_name(type)->delimiter(',');
  };
  if (study != run_box_study && study != run_grains_check) {
    list("--lengths", options->lengths_mm, "Lengths of the box, mm", "MM,...")
        ->check(CLI::Range(20.0, 5000.0));
  }
  if (study == run_resolution_study) {
    list("--bodies", options->bodies, "strip, mirror (half a strip at a smooth wall), foot",
         "NAME,...")
        ->check(CLI::IsMember({"strip", "mirror", "foot"}));
  }
  if (study == run_box_study) {
    list("--bodies", options->bodies, "strip, foot", "NAME,...")
        ->check(CLI::IsMember({"strip", "foot"}));
  }
  if (study == run_grains_check) {
    list("--only", options->bodies, "Only these cases, e.g. worn-spines,wall-near", "NAME,...");
    command->footer(
        "A cause put into grains, against what fast soil makes of the effect that stands for it:\n"
        "the same short press with and without. --full: the paper's own grains. Finished cases\n"
        "are kept: after Ctrl-C the same command goes on where it was.\n"
        "Examples:\n"
        "  hoof study grains-check --threads 2         grains of 1.5 times the paper's, minutes\n"
        "  hoof study grains-check --only worn-spines --beds 10\n"
        "  hoof study grains-check --full --threads 2 --out runs/grains");
  }
  return command;
}

void add_drop_law(CLI::App& parent, Invocation& invocation) {
  auto out = std::make_shared<std::string>();
  CLI::App* command = parent.add_subcommand(
      "drop-law", "The paper's drop test: does L = 2 e H hold, or is tangential speed retained?");
  command->add_option("--out", *out, "Folder for laws.csv and rows.csv [none]")->type_name("DIR");
  command->footer(
      "Fits each law to table 3 of the source paper and predicts each row from the others.\n"
      "Examples:\n"
      "  hoof study drop-law\n"
      "  hoof study drop-law --out runs/drop-law");
  command->callback([&invocation, out] { invocation.run = [out] { run_drop_law_study(*out); }; });
}

void add_foot_proof(CLI::App& parent, Invocation& invocation) {
  auto options = std::make_shared<FootProofOptions>();
  CLI::App* command = parent.add_subcommand(
      "foot-proof", "Physics concealed in the foot's plant, found by its bus alone: with ablation");
  command->add_flag("--full", options->full, "All six effects, and two plants that lack nothing");
  command->add_option("--only", options->only, "Only these cases, e.g. toe-play,hip-friction")
      ->type_name("NAME,...")
      ->delimiter(',');
  command->add_option("--out", options->out, "Folder of sessions, answers and the table")
      ->type_name("DIR")
      ->capture_default_str();
  command->add_option("--threads", options->threads, "1..1024; the answers are the same for any")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--force", options->force, "Replace an earlier proof in DIR");
  command->add_flag("--quiet", options->quiet, "Show no progress");
  command->footer(
      "Each session is recorded over the bus from a plant whose effect is concealed, answered by\n"
      "hoof diagnose, and run once more with improved.toml. On fast soil. Writes proof.json and\n"
      "proof.csv; exit status 1 where an answer is not what was concealed.\n"
      "Examples:\n"
      "  hoof study foot-proof\n"
      "  hoof study foot-proof --full --out runs/foot-proof\n"
      "  hoof study foot-proof --only hip-friction --force");
  command->callback(
      [&invocation, options] { invocation.run = [options] { run_foot_proof_study(*options); }; });
}

}  // namespace

void add_study_command(CLI::App& app, Invocation& invocation) {
  CLI::App* command = app.add_subcommand(
      "study", "Which bed, step and box may be believed; faults in every mode; laws");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hoof study resolution                       coarse grains, minutes\n"
      "  hoof study resolution --full --threads 2    to the paper's grains, an hour\n"
      "  hoof study box --bodies foot --beds 3\n"
      "  hoof study time-step --scales 1\n"
      "  hoof study faults                           every fault in every mode, a minute\n"
      "  hoof study drop-law                         the paper's drop test, at once\n"
      "  hoof study foot-proof                       concealed physics of the foot, a minute\n"
      "  hoof study grains-check                     the soil's effects against grains, minutes");
  add_study(*command, invocation, "resolution",
            "Spined against plain, open against closed: effect over the scatter of beds",
            run_resolution_study);
  add_study(*command, invocation, "time-step", "The same press with steps from 2 to 12 us",
            run_time_step_study);
  add_study(*command, invocation, "cell-size",
            "The same press with cells of 2 to 6 smallest radii: time and equality",
            run_cell_size_study);
  add_study(*command, invocation, "box", "Length, width and depth of the box against the force",
            run_box_study);
  add_fault_matrix(*command, invocation);
  add_drop_law(*command, invocation);
  add_foot_proof(*command, invocation);
  add_study(*command, invocation, "grains-check",
            "Spines worn, wall near, firm layer: does fast soil change as grains do?",
            run_grains_check);
}

}  // namespace hoof::tools
