#include "tools/run/csv_writer.h"

#include <charconv>
#include <stdexcept>
#include <utility>

#include "tools/run/column_unit.h"

namespace hoof::tools {
namespace {

void require_plain(std::string_view text) {
  if (text.find_first_of(",\"\r\n") != std::string_view::npos) {
    throw std::invalid_argument("CSV text would need quoting: " + std::string(text));
  }
}

void append(std::string& line, const CsvCell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) {
    line += format_number(*number);
  } else if (const auto* integer = std::get_if<std::int64_t>(&cell)) {
    line += std::to_string(*integer);
  } else {
    const auto text = std::get<std::string_view>(cell);
    require_plain(text);
    line += text;
  }
}

}  // namespace

std::string format_number(double value) {
  char text[32];  // the longest, "-2.2250738585072014e-308", has 24 characters
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end);
}

CsvWriter::CsvWriter(std::filesystem::path path, std::vector<std::string> columns)
    : columns_(std::move(columns)), file_(std::move(path)) {
  for (const std::string& column : columns_) {
    require_plain(column);
    if (find_column_unit(column) == nullptr) {
      throw std::invalid_argument("column " + column + " does not end in its unit");
    }
    line_ += (line_.empty() ? "" : ",") + column;
  }
  file_.write(line_ += '\n');
}

void CsvWriter::row(std::span<const double> values) {
  require_width(values.size());
  line_.clear();
  for (const double value : values) {
    if (!line_.empty()) line_ += ',';
    line_ += format_number(value);
  }
  file_.write(line_ += '\n');
}

void CsvWriter::row(std::span<const CsvCell> cells) {
  require_width(cells.size());
  line_.clear();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line_ += ',';
    append(line_, cells[i]);
  }
  file_.write(line_ += '\n');
}

void CsvWriter::require_width(std::size_t cell_count) const {
  if (cell_count != columns_.size()) {
    throw std::invalid_argument(file_.path().string() + ": " + std::to_string(cell_count) +
                                " cells for " + std::to_string(columns_.size()) + " columns");
  }
}

}  // namespace hoof::tools
