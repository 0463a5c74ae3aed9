// The studies behind `hoof study`: which bed, step and box may be believed. Each prints a table.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hoof::tools {

/// A list left empty was not given: the study's own choice holds, a longer one with `full`.
struct StudyOptions {
  std::filesystem::path out;   // empty: runs/study-<name>
  std::filesystem::path beds;  // empty: where experiments keep theirs
  std::optional<int> bed_count;
  std::int64_t seed = 1;  // of the first bed; the next ones count on
  std::optional<int> threads;
  std::vector<double> scales;      // grain diameters over the paper's
  std::vector<double> lengths_mm;  // of the box, across the strip
  std::vector<std::string> bodies;
  std::vector<std::string> settings;  // each "key=value", as given by --set
  bool full = false;
  bool quiet = false;
};

/// Spined against plain, open against closed, paired on the same beds: effect, scatter, and what
/// differences a bed of these grains can show at all.
void run_resolution_study(const StudyOptions& options);
/// The same press on the same bed with steps from 2 to 12 us (at the paper's grain size).
void run_time_step_study(const StudyOptions& options);
/// The same press with cells of the neighbour search from 2 to 6 smallest radii: time and equality.
void run_cell_size_study(const StudyOptions& options);
/// Length, width and depth of the box against the force.
void run_box_study(const StudyOptions& options);

}  // namespace hoof::tools
