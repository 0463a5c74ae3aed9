// What a laboratory found: targets with their bands, readings of one measurement by several
// analyses, the runs behind them; as a table to read, files to use and a page to look at.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/config/materials.h"
#include "tools/study/line_plot.h"
#include "tools/study/table.h"

namespace hoof::tools {

/// A number that the source paper gives, or that must hold by physics, and what came out here.
struct Target {
  std::string name, unit;           // unit "" is 1
  std::optional<double> paper;      // what the paper has
  std::optional<double> low, high;  // band that is accepted; neither: shown only
  double ours = 0;
  int digits = 2;

  bool has_band() const { return low || high; }
  bool inside() const;
};

/// A coefficient (or a length) read off one measurement: by the paper's analysis and by others.
struct Reading {
  std::string analysis;
  double value = 0;  // NaN: this analysis gives none
  std::string why;   // one sentence
};

struct Findings {
  std::string laboratory;  // "restitution"
  std::string title;
  std::vector<std::string> about;  // what was simulated, in sentences
  std::vector<Target> targets;
  std::string readings_of;  // "restitution from the measured L = 50.92 mm"
  int reading_digits = 4;
  std::vector<Reading> readings;
  std::vector<std::string> notes;  // what the numbers do not tell
  std::string x_label, y_label;
  std::vector<PlotLine> lines;
  std::optional<Table> runs;
  std::optional<Table> rows;    // of a table of the paper, ours beside its own
  std::string rows_name;        // "table2": rows go to table2.csv
  std::optional<Table> design;  // every run of them, for hoof anova: design.csv
};

/// Coefficients as flags gave them, in place of those of the material.
struct CoefficientFlags {
  std::optional<double> restitution, static_friction, rolling_friction;
};

/// A material of the form of sim/config/materials/paper.toml, that one where `file` is empty, with
/// the flags' values put into one of its pairs.
/// @throws sim::ConfigError naming file, line, key, value and bound
sim::Materials lab_materials(const std::filesystem::path& file, const CoefficientFlags& flags,
                             sim::ContactPair sim::Materials::*pair);

/// Targets, rows and readings in Markdown, about and notes as sentences.
std::string findings_text(const Findings& findings);

/// result.json, runs.csv, the rows and report.html in `folder`, which is made if need be. Equal
/// findings give equal bytes. @throws UserError where a file cannot be written
void write_findings(const Findings& findings, const sim::Materials& materials,
                    const std::filesystem::path& folder);

}  // namespace hoof::tools
