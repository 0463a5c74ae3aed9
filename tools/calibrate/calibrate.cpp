#include "tools/calibrate/calibrate.h"

#include <algorithm>
#include <iostream>
#include <string>

#include "tools/calibrate/repose_table.h"
#include "tools/run/errors.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const CalibrateOptions& options, const std::string& laboratory) {
  return options.out.empty() ? fs::path("runs") / ("calibrate-" + laboratory) : options.out;
}

void report(const Findings& findings, const sim::Materials& materials, const fs::path& folder) {
  write_findings(findings, materials, folder);
  std::cout << findings_text(findings) << "\n" << (folder / "report.html").string() << std::endl;
}

template <class Find>
void run_single_grain(const std::string& laboratory, const CalibrateOptions& options,
                      const Find& find) {
  const sim::Materials materials =
      lab_materials(options.material, options.flags, &sim::Materials::sand_abs);
  ProgressLine line(laboratory, choose_progress_style(options.quiet), std::cerr);
  StopRequest stop;
  try {
    const Findings findings = find(materials, [&](double share, const std::string& doing) {
      line.update(share, doing);
      return !stop.requested();
    });
    line.update(1, "");
    line.finish();
    report(findings, materials, folder_of(options, laboratory));
  } catch (const LabStopped&) {
    line.finish();
    throw Interrupted("stopped; nothing was written, the same command begins anew",
                      stop.exit_status());
  } catch (const std::invalid_argument&) {
    line.finish();
    throw;
  } catch (const std::runtime_error& error) {
    line.finish();
    throw CannotFinish(error.what());
  }
}

/// The response surface of the heaps of table 2 and what of it gives the measured angle; files in
/// anova/. Too few rows told for a quadratic are told, no failure.
std::string analyse_table(const fs::path& folder) {
  try {
    return "\nResponse surface of these heaps:\n\n" +
           analyse_repose(folder / "design.csv", folder / "anova");
  } catch (const UserError& error) {
    return std::string("\nNo response surface of these heaps: ") + error.what() + "\n";
  }
}

}  // namespace

void calibrate_restitution(const CalibrateOptions& options, const RestitutionSettings& settings) {
  run_single_grain("restitution", options, [&](const auto& materials, const auto& progress) {
    return find_restitution(materials, settings, progress);
  });
}

void calibrate_rolling(const CalibrateOptions& options, const RollingSettings& settings) {
  run_single_grain("rolling", options, [&](const auto& materials, const auto& progress) {
    return find_rolling(materials, settings, progress);
  });
}

void calibrate_sliding(const CalibrateOptions& options, const SlidingSettings& settings) {
  run_single_grain("sliding", options, [&](const auto& materials, const auto& progress) {
    return find_sliding(materials, settings, progress);
  });
}

void calibrate_repose(const CalibrateOptions& options, const ReposeSettings& settings,
                      int threads) {
  const sim::Materials materials =
      lab_materials(options.material, options.flags, &sim::Materials::sand_sand);
  const fs::path folder = folder_of(options, "repose");
  const auto cases = repose_cases(materials, settings);
  ProgressLine line("repose", choose_progress_style(options.quiet), std::cerr);
  StopRequest stop;
  std::vector<HeapResult> results;
  try {
    results =
        make_heaps(cases, folder / "heaps", threads, [&](double share, const std::string& doing) {
          line.update(share, doing);
          return !stop.requested();
        });
  } catch (const UserError&) {
    line.finish();
    throw;
  } catch (const std::runtime_error& error) {
    line.finish();
    throw CannotFinish(error.what());
  }
  line.finish();
  if (results.empty()) {
    throw Interrupted("stopped; heaps are kept in " + (folder / "heaps").string() +
                          " and the same command goes on from there",
                      stop.exit_status());
  }
  const auto tells = [](const HeapResult& r) { return r.tells(); };
  if (std::none_of(results.begin(), results.end(), tells)) {
    throw CannotFinish(results.front().why);  // of all the same seeds and settings
  }
  report(find_repose(materials, settings, cases, results), materials, folder);
  if (settings.table2) std::cout << analyse_table(folder);
}

}  // namespace hoof::tools
