#include "tools/reproduce/paper_numbers.h"

#include <algorithm>
#include <array>
#include <iostream>

#include "tools/calibrate/paper_tables.h"
#include "tools/calibrate/repose_table.h"
#include "tools/run/csv_writer.h"
#include "tools/run/progress_line.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

constexpr double kHeap_core_s = 28;  // of 3000 grains, mean of a whole table 2 on a Xeon

// Colour maps of fields, by the requirements that this project was given with the paper's numbers.
constexpr std::array kFields = {14, 16, 20, 21, 24, 26, 27};

/// Table 2 by the paper's own analysis, from its own numbers.
void analyse_again(const fs::path& folder) {
  fs::create_directories(folder);
  CsvWriter csv(folder / "paper.csv", {"e_ratio", "mu_r_ratio", "mu_s_ratio", "repose_deg"});
  for (const ReposeRow& row : paper_repose_table()) {
    csv.row({row.restitution, row.rolling_friction, row.static_friction, row.angle_deg});
  }
  csv.close();
  std::cout << analyse_repose(folder / "paper.csv", folder / "paper-anova") << "\n";
}

ReposeSettings heaps(const TableOptions& options) {
  ReposeSettings settings;
  settings.table2 = true;
  settings.seeds = options.heaps;
  settings.test.grains = options.grains;
  return settings;
}

}  // namespace

std::vector<std::string> paper_numbers() {
  std::vector<std::string> names;
  for (int figure = 5; figure <= 29; ++figure) {
    // Figure 9 is none of the experiments.
    if (figure != 9) names.push_back("fig" + std::to_string(figure));
  }
  for (int table = 2; table <= 5; ++table) names.push_back("table" + std::to_string(table));
  return names;
}

bool is_paper_table(const std::string& name) {
  return name.starts_with("table");
}

std::string about_figure(const std::string& name) {
  const int number = std::stoi(name.substr(3));
  if (std::find(kFields.begin(), kFields.end(), number) != kFields.end()) {
    return name +
           ": a colour map of a field in the sand or on the sole; of which run and field is "
           "not known here, and this command draws none: see report.html of a run";
  }
  return name +
         ": what it shows is not known here, as the paper's captions are not at hand; its "
         "curves by content: hoof reproduce load, opening, traction, traction-opening";
}

void reproduce_table(const std::string& name, const TableOptions& options) {
  CalibrateOptions lab;
  lab.out = options.campaign / name;
  lab.quiet = options.quiet;
  if (name == "table2") {
    analyse_again(lab.out);
    calibrate_repose(lab, heaps(options), options.threads);
  } else if (name == "table3") {
    calibrate_restitution(lab, {});
  } else if (name == "table4") {
    calibrate_sliding(lab, {});
  } else {
    calibrate_rolling(lab, {});
  }
}

std::string table_plan(const std::string& name, const TableOptions& options) {
  const bool there = fs::exists(options.campaign / name / "result.json");
  std::string what = "hoof calibrate restitution";
  if (name == "table2") {
    what = std::to_string(options.heaps) + " heaps of " + std::to_string(options.grains) +
           " grains of each of 13 combinations and of the calibrated one, hoof calibrate repose, "
           "about " +
           format_duration(kHeap_core_s * options.grains / 3000 * 14 * options.heaps) +
           " of a core";
  } else if (name == "table4") {
    what = "hoof calibrate sliding";
  } else if (name == "table5") {
    what = "hoof calibrate rolling";
  }
  return std::string(there ? "done     " : "missing  ") + name + ": " + what;
}

}  // namespace hoof::tools
