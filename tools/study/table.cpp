#include "tools/study/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tools/run/column_unit.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

std::string heading(const std::string& name) {
  const ColumnUnit* unit = find_column_unit(name);
  const std::string symbol = unit == nullptr ? "" : std::string(unit->symbol);
  std::string text = column_label(name);
  if (name.ends_with("_count")) text.resize(text.size() - std::string(" count").size());
  return symbol.empty() || symbol == "1" ? text : text + ", " + symbol;
}

/// Columns on a terminal: a unit's ° has two bytes in UTF-8.
std::size_t width_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

}  // namespace

void Table::row(std::vector<Cell> cells) {
  if (cells.size() != columns_.size()) {
    throw std::invalid_argument("table: " + std::to_string(cells.size()) + " cells for " +
                                std::to_string(columns_.size()) + " columns");
  }
  rows_.push_back(std::move(cells));
}

std::string Table::printed(const Cell& cell, int digits) const {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return std::to_string(*integer);
  const double value = std::get<double>(cell);
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string Table::markdown() const {
  std::vector<std::vector<std::string>> lines(1);
  for (const Column& c : columns_) lines.front().push_back(heading(c.name));
  for (const auto& row : rows_) {
    lines.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) {
      lines.back().push_back(printed(row[i], columns_[i].digits));
    }
  }
  std::vector<std::size_t> width(columns_.size(), 3);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) width[i] = std::max(width[i], width_of(line[i]));
  }
  std::string text;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (std::size_t i = 0; i < lines[k].size(); ++i) {
      text += "| " + lines[k][i] + std::string(width[i] - width_of(lines[k][i]), ' ') + " ";
    }
    text += "|\n";
    if (k > 0) continue;
    for (const std::size_t w : width) text += "| " + std::string(w, '-') + " ";
    text += "|\n";
  }
  return text;
}

void Table::write_csv(const std::filesystem::path& file) const {
  std::vector<std::string> names;
  for (const Column& c : columns_) names.push_back(c.name);
  std::filesystem::path partial = file;
  partial += ".partial";
  CsvWriter csv(partial, names);
  for (const auto& row : rows_) {
    std::vector<CsvCell> cells;
    for (const Cell& cell : row) {
      std::visit([&cells](const auto& value) { cells.emplace_back(value); }, cell);
    }
    csv.row(cells);
  }
  csv.close();
  std::filesystem::rename(partial, file);
}

}  // namespace hoof::tools
