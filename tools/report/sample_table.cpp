#include "tools/report/sample_table.h"

#include <charconv>
#include <string_view>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = 0; (end = text.find(separator)) != std::string_view::npos;) {
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  parts.push_back(text);
  return parts;
}

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t line,
                       const std::string& what) {
  throw UserError(path.string() + ":" + std::to_string(line) + ": " + what);
}

}  // namespace

const SampleColumn* SampleTable::find(const std::string& name) const {
  for (const SampleColumn& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

SampleTable read_samples(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  if (!text.ends_with('\n')) fail(path, 1, "does not end in a line break; cut short?");
  const auto lines = split(std::string_view(text).substr(0, text.size() - 1), '\n');

  SampleTable table;
  for (const std::string_view name : split(lines.front(), ',')) {
    table.columns.push_back({std::string(name), {}, {}});
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = split(lines[i], ',');
    if (cells.size() != table.columns.size()) {
      fail(path, i + 1,
           std::to_string(cells.size()) + " cells for " + std::to_string(table.columns.size()) +
               " columns");
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      SampleColumn& column = table.columns[c];
      if (column.is_text()) {
        column.texts.emplace_back(cells[c]);
        continue;
      }
      double number = 0.0;
      const char* const end = cells[c].data() + cells[c].size();
      const auto read = std::from_chars(cells[c].data(), end, number);
      if (read.ec != std::errc() || read.ptr != end) {
        fail(path, i + 1, column.name + " = '" + std::string(cells[c]) + "' is not a number");
      }
      column.numbers.push_back(number);
    }
  }
  return table;
}

}  // namespace hoof::tools
