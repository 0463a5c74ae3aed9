#include "tools/diagnose/csv_table.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::size_t kShownCellLength = 40;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string shown(std::string_view cell) {
  return cell.size() > kShownCellLength ? std::string(cell.substr(0, kShownCellLength)) + "..."
                                        : std::string(cell);
}

/// False where the text is no number at all; infinities are left to the caller.
bool parse_number(std::string_view text, double& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);  // knows nan and inf, any case
  return read.ec == std::errc() && read.ptr == end;
}

class CsvReader {
 public:
  CsvReader(std::string text, const std::string& name) : text_(std::move(text)) {
    table_.file = name;
    rest_ = text_;
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }

  CsvTable read(const std::set<std::string>& wanted) {
    if (text_.find('\0') != std::string::npos) {
      throw UserError(table_.file + ": holds bytes of zero: not a CSV file in UTF-8 or ASCII");
    }
    if (!next_line()) {
      throw UserError(table_.file + ": empty; the first line must name the columns");
    }
    read_names(wanted);
    while (next_line()) read_row();
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw UserError(table_.file + ":" + std::to_string(line_number_) + ": " + what);
  }

  /// Steps to the next line that is neither comment nor empty.
  bool next_line() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_number_;
      if (line_.ends_with('\r')) line_.remove_suffix(1);
      if (line_.find('\r') != std::string_view::npos) {
        fail("a carriage return inside the line; lines must end in LF or CR LF");
      }
      const std::string_view content = trimmed(line_);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }

  /// Cells of the line, blanks around them taken off. A cell in quotes may hold commas; "" in it
  /// is one quote.
  void split() {
    cells_.clear();
    std::string_view rest = line_;
    for (bool more = true; more;) {
      const std::size_t first = rest.find_first_not_of(" \t");
      if (first != std::string_view::npos && rest[first] == '"') {
        rest.remove_prefix(first + 1);
        take_quoted(rest);
      } else {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        cells_.emplace_back(trimmed(rest.substr(0, comma)));
        rest.remove_prefix(comma);
      }
      more = !rest.empty();
      if (more) rest.remove_prefix(1);  // the comma
    }
  }

  void take_quoted(std::string_view& rest) {
    std::string cell;
    for (;;) {
      const std::size_t quote = rest.find('"');
      if (quote == std::string_view::npos) fail("a quote that is not closed in its line");
      cell += rest.substr(0, quote);
      rest.remove_prefix(quote + 1);
      if (!rest.starts_with('"')) break;
      cell += '"';
      rest.remove_prefix(1);
    }
    const std::size_t comma = std::min(rest.find(','), rest.size());
    if (!trimmed(rest.substr(0, comma)).empty()) fail("text after a closing quote");
    rest.remove_prefix(comma);
    cells_.emplace_back(trimmed(cell));
  }

  void read_names(const std::set<std::string>& wanted) {
    split();
    refuse_other_formats();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const std::string& name = cells_[i];
      const int before = name.empty() ? -1 : table_.find(name);
      if (before >= 0) {
        fail("two columns are named " + shown(name) + ": " + std::to_string(before + 1) + " and " +
             std::to_string(i + 1));
      }
      table_.names.push_back(name);
      wanted_.push_back(wanted.contains(name));
    }
    table_.columns.resize(cells_.size());
  }

  void refuse_other_formats() const {
    const char* other = cells_.size() > 1                                     ? nullptr
                        : line_.find(';') != std::string_view::npos           ? "semicolons"
                        : trimmed(line_).find('\t') != std::string_view::npos ? "tabs"
                                                                              : nullptr;
    if (other != nullptr) {
      fail(std::string("columns are separated by ") + other + "; they must be separated by commas");
    }
    double value = 0;
    if (parse_number(cells_.front(), value)) {
      fail("begins with " + shown(cells_.front()) + "; the first line must name the columns");
    }
  }

  void read_row() {
    split();
    if (cells_.size() != table_.names.size()) {
      fail(std::to_string(cells_.size()) + " cells for " + std::to_string(table_.names.size()) +
           " columns");
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (wanted_[i]) table_.columns[i].push_back(number(i));
    }
    table_.lines.push_back(line_number_);
  }

  double number(std::size_t column) const {
    const std::string& cell = cells_[column];
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!cell.empty() && (!parse_number(cell, value) || std::isinf(value))) {
      fail(table_.names[column] + " = \"" + shown(cell) +
           "\": must be a finite number, or NaN or nothing where a sample is missing");
    }
    return value;
  }

  std::string text_;
  std::string_view rest_, line_;
  int line_number_ = 0;
  std::vector<std::string> cells_;
  std::vector<bool> wanted_;
  CsvTable table_;
};

}  // namespace

int CsvTable::find(const std::string& name) const {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<int>(i);
  }
  return -1;
}

CsvTable read_csv(const std::filesystem::path& file, const std::set<std::string>& wanted) {
  return parse_csv(read_file(file), file.string(), wanted);
}

CsvTable parse_csv(std::string text, const std::string& name, const std::set<std::string>& wanted) {
  return CsvReader(std::move(text), name).read(wanted);
}

}  // namespace hoof::tools
