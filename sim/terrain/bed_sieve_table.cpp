#include "sim/terrain/bed_sieve_table.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "sim/config/config_error.h"
#include "sim/config/settings.h"

namespace hoof::sim {
namespace {

// Shares of tables are printed with two digits after the point; a column of ten adds up to 100
// within this.
constexpr double kRounding_percent = 0.05;

struct Row {
  int line;
  double aperture_mm;
  double percent;
};

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& file) : file_(file.string()), in_(file) {
    if (!in_) throw ConfigError(file_ + ": cannot read: " + std::strerror(errno));
  }

  /// Rows with the share that passes each aperture, percent.
  std::vector<Row> passing() {
    read_header();
    std::string text;
    while (next_line(text)) rows_.push_back(read_row(text));
    if (rows_.size() < 2) {
      fail("has " + std::to_string(rows_.size()) + " sieves, must have at least 2");
    }
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (rows_[i].aperture_mm <= rows_[i - 1].aperture_mm) {
        fail(rows_[i], "aperture_mm", rows_[i].aperture_mm,
             "must be above that of the row before, " + number(rows_[i - 1].aperture_mm));
      }
    }
    if (retained_) accumulate();
    require_passing();
    return rows_;
  }

  [[noreturn]] void fail(const std::string& rule) const { throw ConfigError(file_ + ": " + rule); }

  static std::string number(double value) { return to_text(Value(value)); }

 private:
  [[noreturn]] void fail(const Row& row, const char* column, double value,
                         const std::string& rule) const {
    throw ConfigError(file_ + ":" + std::to_string(row.line) + ": " + column + " = " +
                      number(value) + ": " + rule);
  }

  /// Blank lines and comments are passed over.
  bool next_line(std::string& text) {
    while (std::getline(in_, text)) {
      ++line_;
      if (!text.empty() && text.back() == '\r') text.pop_back();
      if (text.find_first_not_of(" \t") != std::string::npos && text[0] != '#') return true;
    }
    return false;
  }

  void read_header() {
    std::string text;
    next_line(text);
    retained_ = text == "aperture_mm,retained_percent";
    if (retained_ || text == "aperture_mm,passing_percent") return;
    throw ConfigError(file_ + ":" + std::to_string(std::max(1, line_)) + ": '" + text +
                      "': must be aperture_mm,passing_percent or aperture_mm,retained_percent");
  }

  Row read_row(std::string_view text) const {
    const std::size_t comma = text.find(',');
    Row row{line_, 0, 0};
    if (comma == std::string_view::npos || !parse(text.substr(0, comma), row.aperture_mm) ||
        !parse(text.substr(comma + 1), row.percent)) {
      throw ConfigError(file_ + ":" + std::to_string(line_) + ": '" + std::string(text) +
                        "': must be two numbers with a comma between them");
    }
    if (!(row.aperture_mm >= 0 && row.aperture_mm <= 100)) {
      fail(row, "aperture_mm", row.aperture_mm, "must be a number from 0 to 100");
    }
    if (!(row.percent >= 0 && row.percent <= 100)) {
      fail(row, column(), row.percent, "must be a number from 0 to 100");
    }
    return row;
  }

  static bool parse(std::string_view text, double& value) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  }

  const char* column() const { return retained_ ? "retained_percent" : "passing_percent"; }

  /// From what lies on each sieve to what passes it.
  void accumulate() {
    const Row& widest = rows_.back();
    if (widest.percent != 0) {
      fail(widest, column(), widest.percent,
           "must be 0 for the widest sieve: nobody knows how large its grains are");
    }
    double below = 0;
    for (Row& row : rows_) {
      const double retained = row.percent;
      row.percent = below;
      below += retained;
    }
    if (std::abs(below - 100) > kRounding_percent) {
      fail("retained_percent adds up to " + number(below) + ", must be 100 within " +
           number(kRounding_percent));
    }
  }

  void require_passing() const {
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      if (rows_[i].percent < rows_[i - 1].percent) {
        fail(rows_[i], column(), rows_[i].percent,
             "must not be under that of the row before, " + number(rows_[i - 1].percent));
      }
    }
    const Row& widest = rows_.back();
    if (!retained_ && std::abs(widest.percent - 100) > kRounding_percent) {
      fail(widest, column(), widest.percent, "must be 100 for the widest sieve");
    }
  }

  std::string file_;
  std::ifstream in_;
  int line_ = 0;
  bool retained_ = false;
  std::vector<Row> rows_;
};

}  // namespace

std::vector<SieveClass> read_sieve_table(const std::filesystem::path& file,
                                         const SieveSelection& selection) {
  TableReader table(file);
  const std::vector<Row> rows = table.passing();
  // Mass that passes the finest sieve has no lower size: it takes part only if zero is a row.
  const double finest_mm = rows.front().aperture_mm, widest_mm = rows.back().aperture_mm;
  const double from_mm = selection.from_m ? *selection.from_m * 1e3 : finest_mm;
  const double to_mm = selection.to_m ? *selection.to_m * 1e3 : widest_mm;
  const auto range = TableReader::number(from_mm) + " to " + TableReader::number(to_mm) + " mm";
  // Metres and back lose the last digit.
  const double slack_mm = 1e-9 * widest_mm;
  if (!(from_mm >= finest_mm - slack_mm && to_mm <= widest_mm + slack_mm && from_mm < to_mm)) {
    table.fail("the range " + range + " must lie within its sieves, " +
               TableReader::number(finest_mm) + " to " + TableReader::number(widest_mm) + " mm");
  }
  if (from_mm <= 0) table.fail("the range " + range + " must begin above 0: such grains are dust");

  std::vector<SieveClass> classes;
  double total = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double a_mm = rows[i - 1].aperture_mm, b_mm = rows[i].aperture_mm;
    const double low_mm = std::max(a_mm, from_mm), high_mm = std::min(b_mm, to_mm);
    const double share =
        (rows[i].percent - rows[i - 1].percent) * (high_mm - low_mm) / (b_mm - a_mm);
    if (high_mm - low_mm <= slack_mm || share <= 0) continue;
    classes.push_back({selection.scale * low_mm * 1e-3, selection.scale * high_mm * 1e-3, share});
    total += share;
  }
  if (classes.empty()) table.fail("no mass in the range " + range);
  for (SieveClass& c : classes) c.mass_share /= total;
  return classes;
}

}  // namespace hoof::sim
