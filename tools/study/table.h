// A table of results: printed in Markdown, so that it can go into a text as it is, and as CSV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace hoof::tools {

class Table {
 public:
  struct Column {
    std::string name;  // ends in its unit (tools/run/column_unit.h)
    int digits = 0;    // after the point, where it is printed
  };
  using Cell = std::variant<double, std::int64_t, std::string>;

  explicit Table(std::vector<Column> columns) : columns_(std::move(columns)) {}

  /// @throws std::invalid_argument where the number of cells is not that of columns
  void row(std::vector<Cell> cells);

  /// Headings with units; a number that is not finite is "-".
  std::string markdown() const;
  /// Through a temporary file. @throws UserError where it cannot be written
  void write_csv(const std::filesystem::path& file) const;

  std::size_t rows() const { return rows_.size(); }

 private:
  std::string printed(const Cell& cell, int digits) const;

  std::vector<Column> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace hoof::tools
