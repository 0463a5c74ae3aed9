#include "tools/trajectory/case_table.h"

#include <cstdlib>
#include <istream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;
using firmware::trajectory::Synchronisation;

constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

double number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);  // reads inf and nan too
  if (end == text.c_str() || *end != '\0') throw std::runtime_error("not a number: " + text);
  return value;
}

double number_or_empty(const std::string& text) {
  return text.empty() ? kEmpty : number(text);
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> values;
  std::istringstream in(text);
  for (std::string word; in >> word;) values.push_back(number(word));
  return values;
}

class Row {
 public:
  Row(const std::map<std::string, std::size_t>& columns, const std::vector<std::string>& cells)
      : columns_(columns), cells_(cells) {}

  const std::string& text(const std::string& column) const {
    const auto found = columns_.find(column);
    if (found == columns_.end()) throw std::runtime_error("no column " + column);
    if (found->second >= cells_.size()) throw std::runtime_error("no cell for " + column);
    return cells_[found->second];
  }

  void vector(const std::string& column, int joints, Input::Vector& out) const {
    const std::vector<double> values = numbers(text(column));
    if (static_cast<int>(values.size()) != joints) {
      throw std::runtime_error("column " + column + " does not have one value per axis");
    }
    for (int i = 0; i < joints; ++i) out[i] = values[i];
  }

 private:
  const std::map<std::string, std::size_t>& columns_;
  const std::vector<std::string>& cells_;
};

Synchronisation synchronisation(const std::string& text) {
  if (text == "none") return Synchronisation::kNone;
  if (text == "time") return Synchronisation::kTime;
  if (text == "phase") return Synchronisation::kPhase;
  throw std::runtime_error("unknown synchronisation " + text);
}

void read_input(const Row& row, Input& input) {
  input.joints = static_cast<int>(number(row.text("n")));
  if (input.joints < 1 || input.joints > kMaxJoints) {
    throw std::runtime_error("between 1 and 8 axes are supported");
  }
  input.interface = row.text("ctrl") == "V" ? Interface::kVelocity : Interface::kPosition;
  input.synchronisation = synchronisation(row.text("sync"));
  if (!row.text("tmin").empty()) input.minimum_duration_s = number(row.text("tmin"));
  if (!row.text("delta").empty()) input.duration_step_s = number(row.text("delta"));
  const int n = input.joints;
  row.vector("p0", n, input.position);
  row.vector("v0", n, input.velocity);
  row.vector("a0", n, input.acceleration);
  row.vector("pf", n, input.target_position);
  row.vector("vf", n, input.target_velocity);
  row.vector("af", n, input.target_acceleration);
  row.vector("vmax", n, input.max_velocity);
  row.vector("vmin", n, input.min_velocity);
  row.vector("amax", n, input.max_acceleration);
  row.vector("amin", n, input.min_acceleration);
  row.vector("jmax", n, input.max_jerk);
}

Case read_case(const Row& row) {
  Case out;
  out.id = static_cast<int>(number(row.text("id")));
  out.family = row.text("cat");
  read_input(row, out.input);
  out.result = static_cast<int>(number(row.text("result")));
  out.duration_s = number_or_empty(row.text("duration"));
  out.minimum_s = numbers(row.text("min_durations"));
  out.axis_check_s = numbers(row.text("axis_check"));
  out.group_check_s = number_or_empty(row.text("group_check"));
  const std::string& agree = row.text("agree");
  out.agreement = agree.empty()  ? Case::Agreement::kUnchecked
                  : agree == "1" ? Case::Agreement::kAgree
                                 : Case::Agreement::kDiffer;
  return out;
}

}  // namespace

std::vector<Case> read_cases(std::istream& in) {
  std::string line;
  if (!std::getline(in, line)) throw std::runtime_error("the case file is empty");
  std::map<std::string, std::size_t> columns;
  for (const std::string& name : split(line)) columns.emplace(name, columns.size());
  std::vector<Case> cases;
  for (int line_number = 2; std::getline(in, line); ++line_number) {
    if (line.empty()) continue;
    try {
      const std::vector<std::string> cells = split(line);
      cases.push_back(read_case(Row(columns, cells)));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("line " + std::to_string(line_number) + ": " + error.what());
    }
  }
  return cases;
}

}  // namespace hoof::tools::trajectory
