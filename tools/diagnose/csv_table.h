// Tables of numbers as other people's programs write them.
//
// Beside tools/report's sample_table, which takes nothing but what this project writes: here are
// comments, quotes, line ends of both kinds and missing samples.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace hoof::tools {

struct CsvTable {
  std::string file;
  std::vector<std::string> names;            // all columns
  std::vector<std::vector<double>> columns;  // empty for a column not asked for; NaN: missing
  std::vector<int> lines;                    // of each row, counted from 1

  /// -1 where there is no such column.
  int find(const std::string& name) const;
};

/// First line: names of columns. Lines that begin with # are comments, empty lines are passed
/// over. A cell is a decimal number, or NaN or empty for a missing sample, in quotes or not.
/// @param wanted columns to read as numbers; others may hold anything
/// @throws UserError "runs/a.csv:17: ..." for everything else
CsvTable read_csv(const std::filesystem::path& file, const std::set<std::string>& wanted);

/// The same of text; `name` stands for the file in messages.
CsvTable parse_csv(std::string text, const std::string& name, const std::set<std::string>& wanted);

}  // namespace hoof::tools
