#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "tools/run/output_file.h"

namespace hoof::tools {

/// Shortest decimal text that reads back as exactly `value` (std::to_chars): the same bytes on
/// every run and in every locale. Not-a-number is written "nan", which numpy and pandas read.
std::string format_number(double value);

/// One value of a row. Text must not need quoting (no comma, quote or line break).
using CsvCell = std::variant<double, std::int64_t, std::string_view>;

/// Writes a table with one header line, such as samples.csv.
class CsvWriter {
 public:
  /// Throws std::invalid_argument where a column's name does not end in its unit
  /// (column_unit.h), UserError where the file cannot be written.
  CsvWriter(std::filesystem::path path, std::vector<std::string> columns);

  /// Throws std::invalid_argument where the number of cells is not the number of columns.
  void row(std::span<const double> values);
  void row(std::span<const CsvCell> cells);
  void row(std::initializer_list<CsvCell> cells) { row(std::span(cells.begin(), cells.size())); }

  /// Flushes and closes; a UserError says so if not every byte arrived.
  void close() { file_.close(); }

 private:
  void require_width(std::size_t cell_count) const;

  std::vector<std::string> columns_;
  OutputFile file_;
  std::string line_;
};

}  // namespace hoof::tools
