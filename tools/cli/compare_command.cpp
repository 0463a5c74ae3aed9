#include <filesystem>
#include <iostream>
#include <memory>

#include "tools/cli/commands.h"
#include "tools/compare/compare_text.h"
#include "tools/compare/comparison.h"
#include "tools/log/bus_recording.h"
#include "tools/log/decoded_frame.h"
#include "tools/log/signal_series.h"
#include "tools/run/differs.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

struct CompareRequest {
  fs::path a, b;
  bool bus = false;
  std::vector<std::string> signals, tolerances;
  std::string align;
  double longest_shift_s = 1;
  fs::path html;
};

/// The samples of a run's folder; the signals of a log, or of a folder's log where the bus is asked
/// for.
std::vector<SignalSeries> read_series(const fs::path& path, const CompareRequest& request) {
  const bool folder = fs::is_directory(path);
  if (folder && !request.bus) return series_of_samples(path / "samples.csv", request.signals);
  if (path.extension() == ".csv") return series_of_samples(path, request.signals);
  return series_of(read_bus_log(path), request.signals);
}

void run(const CompareRequest& request) {
  CompareOptions options;
  for (const std::string& text : request.tolerances) {
    options.tolerances.push_back(parse_tolerance_rule(text));
  }
  options.align_signal = request.align;
  options.longest_shift_s = request.longest_shift_s;
  const auto a = read_series(request.a, request), b = read_series(request.b, request);
  if (a.empty()) throw UserError(request.a.string() + ": no such signals");
  if (b.empty()) throw UserError(request.b.string() + ": no such signals");
  for (const ToleranceRule& rule : options.tolerances) {
    bool used = false;
    for (const SignalSeries& s : a) used = used || matches_pattern(rule.pattern, s.name);
    if (!used) throw UserError("--tol " + rule.pattern + ": fits no signal of A");
  }
  const Comparison comparison = compare(a, b, options);
  const ComparedNames names{request.a.string(), request.b.string()};
  print_comparison(comparison, names, std::cout);
  if (!request.html.empty()) {
    write_file(request.html, comparison_page(comparison, names));
    std::cout << request.html.string() << "\n";
  }
  if (!comparison.within()) throw Differs("A and B differ by more than is allowed");
}

}  // namespace

void add_compare_command(CLI::App& app, Invocation& invocation) {
  auto request = std::make_shared<CompareRequest>();
  CLI::App* command = app.add_subcommand("compare", "Two runs or two bus logs, signal by signal");
  command->add_option("A", request->a, "Baseline: folder of a run, samples.csv, or a bus log")
      ->required();
  command->add_option("B", request->b, "What is compared with it")->required();
  command->add_flag("--bus", request->bus, "Of run folders compare the bus, not samples.csv");
  command->add_option("--signal", request->signals, "Only these; * stands for any characters")
      ->allow_extra_args(false);
  command
      ->add_option("--tol", request->tolerances,
                   "SIGNAL=ABSOLUTE[,RELATIVE] in SI units: allowed is the larger of ABSOLUTE and "
                   "RELATIVE times A; the default goes by the signal's unit")
      ->allow_extra_args(false);
  command->add_option("--align", request->align, "Move B in time so that this signal fits best");
  command->add_option("--longest-shift", request->longest_shift_s, "Of --align, in seconds")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("--html", request->html, "Also write a page with plots")->type_name("FILE");
  command->footer(
      "Exit status: 0 all within tolerance, 1 something is not.\n"
      "Examples:\n"
      "  hoof compare runs/a runs/b --html compare.html\n"
      "  hoof compare runs/a runs/b --tol depth_m=0.0005 --tol 'f*_N=5,0.1'\n"
      "  hoof compare a.log b.log --signal 'ToeReply.*' --align ToeReply.position_rad");
  command->callback([&invocation, request] { invocation.run = [request] { run(*request); }; });
}

}  // namespace hoof::tools
