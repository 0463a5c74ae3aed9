// What stands behind the paper's figures and tables by their numbers, as far as it is known here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/calibrate/calibrate.h"

namespace hoof::tools {

/// "fig5" .. "fig8", "fig10" .. "fig29", "table2" .. "table5".
std::vector<std::string> paper_numbers();
bool is_paper_table(const std::string& name);

/// Of a figure, in one line: what is known of it and where its kind of content is made. The paper's
/// text and captions are not part of this project, and nothing is guessed.
std::string about_figure(const std::string& name);

struct TableOptions {
  std::filesystem::path campaign;  // the table goes to its folder NAME
  int heaps = 5;                   // of each combination of table 2
  int grains = 3000;               // of each heap
  int threads = 1;                 // heaps at once
  bool quiet = false;
};

/// Runs the laboratory behind a table, or the paper's own numbers again, and prints the report's
/// path. What is there whole is kept. @throws as the laboratories
void reproduce_table(const std::string& name, const TableOptions& options);

/// One line: what it runs and whether it is there.
std::string table_plan(const std::string& name, const TableOptions& options);

}  // namespace hoof::tools
