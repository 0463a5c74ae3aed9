#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "tools/cli/commands.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/experiment_text.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/diagnose/write_answer.h"
#include "tools/run/errors.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

struct DiagnoseRequest {
  std::vector<fs::path> data_sets;
  fs::path out;
  std::uint64_t seed = DiagnoseOptions().seed;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  bool force = false, quiet = false;
};

std::vector<DataSet> read_all(const std::vector<fs::path>& files) {
  std::vector<DataSet> sets;
  bool any_fit = false;
  for (const fs::path& file : files) {
    sets.push_back(read_data_set(file));
    for (const Recording& r : sets.back().recordings) any_fit = any_fit || !r.holdout;
  }
  if (!any_fit) {
    throw UserError(files.front().string() +
                    ": all recordings have role = \"holdout\"; at least one must be \"fit\"");
  }
  return sets;
}

/// @throws Interrupted where the user asked to stop
Verdict diagnose_with_progress(const std::vector<DataSet>& sets, const DiagnoseRequest& request) {
  const StopRequest stop;
  ProgressLine line("diagnosing", choose_progress_style(request.quiet), std::cerr);
  DiagnoseOptions options;
  options.seed = request.seed;
  options.threads = request.threads;
  options.progress = [&](double share, const std::string& doing) {
    line.update(share, doing);
    return !stop.requested();
  };
  const auto leave_if_stopped = [&] {
    line.finish();
    if (stop.requested()) throw Interrupted("stopped; nothing was written", stop.exit_status());
  };
  try {
    Verdict verdict = diagnose(sets, options);
    leave_if_stopped();
    return verdict;
  } catch (const Interrupted&) {
    throw;
  } catch (...) {
    leave_if_stopped();
    throw;
  }
}

/// What is read must not be replaced by what is written.
void refuse_own_input(const DiagnoseRequest& request) {
  for (const fs::path& file : request.data_sets) {
    std::error_code error;
    const fs::path own = request.out / kExperimentFile;
    if (fs::exists(own, error) && fs::equivalent(file, own, error)) {
      throw UserError("--out " + request.out.string() + ": would replace " + file.string() +
                      ", which is to be read; choose another folder");
    }
  }
}

void run(const DiagnoseRequest& request) {
  const std::vector<DataSet> sets = read_all(request.data_sets);
  refuse_own_input(request);
  AnswerFolder folder(request.out, kVerdictFile, request.force);
  const Verdict verdict = diagnose_with_progress(sets, request);
  write_answer(verdict, sets, folder);
  for (const std::string& line : summary_lines(verdict, sets.front().rig, request.out.string())) {
    std::cout << line << "\n";
  }
}

}  // namespace

void add_diagnose_command(CLI::App& app, Invocation& invocation) {
  auto request = std::make_shared<DiagnoseRequest>();
  CLI::App* command =
      app.add_subcommand("diagnose", "What a model lacks that recordings of a machine show");
  command
      ->add_option("DATASET", request->data_sets,
                   "Data set; several of one machine share its setup and effects")
      ->required()
      ->type_name("DATASET.toml");
  command->add_option("--out", request->out, "Folder for the answer")->required()->type_name("DIR");
  command
      ->add_option(
          "--seed", request->seed,
          "Accepted for scripts; the search draws nothing, any seed gives the same verdict")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--threads", request->threads, "1..1024; the answer is the same for any")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--force", request->force, "Replace an earlier answer in DIR");
  command->add_flag("--quiet", request->quiet, "Show no progress");
  command->footer(
      "Writes verdict.json, report.html, improved.toml, residuals.csv and hypotheses.csv; where\n"
      "recordings do not decide, next_experiment.toml and .csv: what to play on the machine.\n"
      "Exit status: 0 whatever the verdict, 2 bad input, 3 could not finish.\n"
      "Examples:\n"
      "  hoof diagnose tests/data/diagnose/servo_pendulum_xl330/dataset.toml --out runs/xl330\n"
      "  hoof diagnose sand.toml block.toml --out runs/press --seed 7 --threads 2\n"
      "  hoof simulate sand.toml --effects runs/press/improved.toml --out runs/press-improved");
  command->callback([&invocation, request] { invocation.run = [request] { run(*request); }; });
}

}  // namespace hoof::tools
