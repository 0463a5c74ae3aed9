#include "tools/cli/fault_matrix.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "firmware/protocol/dictionary.h"
#include "tools/faults/matrix.h"
#include "tools/faults/matrix_report.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

struct Options {
  std::vector<std::string> modes;
  std::string only;
  int jobs = std::clamp(int(std::thread::hardware_concurrency()), 1, 64);
  std::filesystem::path out = "runs/study-faults";
};

std::vector<std::string> mode_names() {
  std::vector<std::string> names;
  for (const auto& mode : firmware::protocol::kModeNames) names.emplace_back(mode.name);
  return names;
}

void run(const Options& options) {
  MatrixOptions matrix;
  matrix.only = options.only;
  matrix.jobs = options.jobs;
  const std::vector<std::string> names = mode_names();
  for (const std::string& mode : options.modes) {
    const auto place = std::find(names.begin(), names.end(), mode) - names.begin();
    matrix.modes.push_back(static_cast<firmware::control::Mode>(place));
  }
  std::cout << "mode           fault                                 trip   safe  surge  reset     "
               "  bits\n"
               "                                                       ms     ms     ms\n";
  const StopRequest stop;
  const std::vector<MatrixCell> cells = run_matrix(matrix, [&stop](const MatrixCell& cell) {
    std::cout << cell_line(cell) << std::endl;
    return !stop.requested();
  });
  if (stop.requested()) {
    throw Interrupted("stopped after " + std::to_string(cells.size()) + " cells; no table written",
                      stop.exit_status());
  }
  if (cells.empty()) throw UserError("--only " + options.only + ": no fault has that in its name");
  std::filesystem::create_directories(options.out);
  write_file(options.out / "faults.xml", matrix_junit(cells));
  write_file(options.out / "report.html", matrix_html(cells));
  write_file(options.out / "faults.md", matrix_markdown(cells));
  std::size_t missed = 0, gaps = 0;
  for (const MatrixCell& cell : cells) {
    missed += !cell.misses.empty();
    gaps += !cell.gaps.empty();
  }
  std::cout << cells.size() << " cells, " << missed << " missed, " << gaps << " known gaps; table in "
            << (options.out / "report.html").string() << std::endl;
  if (missed > 0) throw BarMissed(std::to_string(missed) + " cells are not as expected");
}

}  // namespace

void add_fault_matrix(CLI::App& study, Invocation& invocation) {
  auto options = std::make_shared<Options>();
  CLI::App* command = study.add_subcommand(
      "faults", "Every fault in every mode: reaction, time to the safe state, recovery");
  command->add_option("--mode", options->modes, "Only these modes [all]")
      ->type_name("MODE,...")
      ->delimiter(',')
      ->check(CLI::IsMember(mode_names()));
  command->add_option("--only", options->only, "Only faults with this in their name")
      ->type_name("TEXT");
  command
      ->add_option("--jobs", options->jobs,
                   "Cells at a time, 1..64 [one per processor]; the table is the same")
      ->type_name("N")
      ->check(CLI::Range(1, 64));
  command->add_option("--out", options->out, "Folder of the table: HTML, markdown, JUnit XML")
      ->type_name("DIR")
      ->capture_default_str();
  command->footer(
      "On rigid ground, in process. Writes report.html, faults.md and faults.xml (JUnit).\n"
      "Exit status 1 where a cell is not as expected.\n"
      "Examples:\n"
      "  hoof study faults\n"
      "  hoof study faults --mode running --only encoder");
  command->callback([&invocation, options] { invocation.run = [options] { run(*options); }; });
}

}  // namespace hoof::tools
