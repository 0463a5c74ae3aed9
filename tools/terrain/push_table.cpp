#include "tools/terrain/push_table.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "tools/report/sample_table.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr const char* kPush = "push";
constexpr const char* kBack = "back";
constexpr const char* kFitted = "fitted";
constexpr const char* kHeldOut = "held_out";

/// A number of a plate: its column and what it may be.
struct Column {
  const char* name;
  double PushCase::*member;
  double min, max;
};

constexpr Column kPlate[] = {
    {"length_m", &PushCase::length_m, 1e-4, 10},
    {"width_m", &PushCase::width_m, 1e-4, 10},
    {"thickness_m", &PushCase::thickness_m, 1e-5, 10},
    {"beta_rad", &PushCase::beta_rad, -kPi / 2, kPi / 2},
    {"psi_rad", &PushCase::psi_rad, -kPi, kPi},
    {"gamma_rad", &PushCase::gamma_rad, -kPi / 2, kPi / 2},
    {"insert_m", &PushCase::insert_m, 0, 10},
    {"push_m", &PushCase::way_m, 1e-4, 10},
    {"back_m", &PushCase::back_m, 0, 10},
};

std::vector<std::string> columns() {
  std::vector<std::string> names = {"case_name", "set_name", "phase_name"};
  for (const Column& column : kPlate) names.emplace_back(column.name);
  for (const char* name : {"way_m", "fx_N", "fy_N", "fz_N"}) names.emplace_back(name);
  return names;
}

class TableReader {
 public:
  explicit TableReader(const std::filesystem::path& file)
      : file_(file), table_(read_samples(file)) {
    rows_ = column("case_name").texts.size();
    if (rows_ == 0) throw UserError(file_.string() + ": holds no pushes");
  }

  std::size_t rows() const { return rows_; }

  const std::string& text(std::size_t row, const char* name) const {
    return column(name).texts[row];
  }

  double number(std::size_t row, const char* name, double min, double max) const {
    const double value = column(name).numbers[row];
    if (value >= min && value <= max) return value;
    fail(row, name, format_number(value),
         max == std::numeric_limits<double>::max()
             ? std::string("a finite number")
             : "in " + format_number(min) + " ... " + format_number(max));
  }

  [[noreturn]] void fail(std::size_t row, const char* name, const std::string& value,
                         const std::string& rule) const {
    // The header is line 1.
    throw UserError(file_.string() + ":" + std::to_string(row + 2) + ": " + name + " = " + value +
                    ": must be " + rule);
  }

 private:
  const SampleColumn& column(const char* name) const {
    if (const SampleColumn* found = table_.find(name)) return *found;
    throw UserError(file_.string() + ":1: no column " + name);
  }

  const std::filesystem::path& file_;
  SampleTable table_;
  std::size_t rows_ = 0;
};

PushCase read_plate(const TableReader& table, std::size_t row) {
  PushCase plate;
  plate.name = table.text(row, "case_name");
  for (const Column& c : kPlate) plate.*c.member = table.number(row, c.name, c.min, c.max);
  const std::string& set = table.text(row, "set_name");
  if (set != kFitted && set != kHeldOut) {
    table.fail(row, "set_name", set, std::string(kFitted) + " or " + kHeldOut);
  }
  plate.held_out = set == kHeldOut;
  return plate;
}

PushSample read_sample(const TableReader& table, std::size_t row) {
  PushSample sample;
  const std::string& phase = table.text(row, "phase_name");
  if (phase != kPush && phase != kBack) {
    table.fail(row, "phase_name", phase, std::string(kPush) + " or " + kBack);
  }
  sample.phase = phase == kPush ? PushPhase::kPush : PushPhase::kBack;
  sample.way_m = table.number(row, "way_m", 0, 10);
  const auto force = [&](const char* name) {
    // NaN breaks both bounds, infinity is beyond them.
    return table.number(row, name, -std::numeric_limits<double>::max(),
                        std::numeric_limits<double>::max());
  };
  sample.force_N = {force("fx_N"), force("fy_N"), force("fz_N")};
  return sample;
}

}  // namespace

void write_pushes(const std::filesystem::path& file, const std::vector<Push>& pushes) {
  std::filesystem::path partial = file;
  partial += ".partial";
  CsvWriter csv(partial, columns());
  for (const Push& push : pushes) {
    for (const PushSample& s : push.samples) {
      std::vector<CsvCell> row = {std::string_view(push.plate.name),
                                  std::string_view(push.plate.held_out ? kHeldOut : kFitted),
                                  std::string_view(s.phase == PushPhase::kBack ? kBack : kPush)};
      for (const Column& c : kPlate) row.emplace_back(push.plate.*c.member);
      for (const double value : {s.way_m, s.force_N.x(), s.force_N.y(), s.force_N.z()}) {
        row.emplace_back(value);
      }
      csv.row(row);
    }
  }
  csv.close();
  std::filesystem::rename(partial, file);
}

std::vector<Push> read_pushes(const std::filesystem::path& file) {
  const TableReader table(file);
  std::vector<Push> pushes;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (pushes.empty() || pushes.back().plate.name != table.text(row, "case_name")) {
      pushes.push_back({read_plate(table, row), {}});
    }
    const PushCase plate = read_plate(table, row);
    for (const Column& c : kPlate) {
      if (plate.*c.member != pushes.back().plate.*c.member) {
        table.fail(row, c.name, format_number(plate.*c.member),
                   format_number(pushes.back().plate.*c.member) + " as in the first row of '" +
                       plate.name + "'");
      }
    }
    pushes.back().samples.push_back(read_sample(table, row));
  }
  return pushes;
}

}  // namespace hoof::tools
