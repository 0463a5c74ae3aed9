#include "tools/reproduce/table_targets.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

struct PaperTable {
  const char* name;
  const char* about;
  const char* chosen_by_it;
};
constexpr PaperTable kTables[] = {
    {"table2", "angle of repose", "outlet and height of fall were chosen by it"},
    {"table3", "drop on a plate", "the height of fall was fitted to the table"},
    {"table4", "tilted plate", "rate of tilt and what is seen to slide were chosen by the table"},
    {"table5", "roll down an incline", "lengths were fitted to the table"}};

double number(const nlohmann::json& value, double otherwise) {
  return value.is_number() ? value.get<double>() : otherwise;
}

void add(const PaperTable& table, const fs::path& file, std::vector<Comparison>& rows) {
  try {
    const auto result = nlohmann::json::parse(read_file(file));
    for (const auto& target : result.at("targets")) {
      const double low = number(target.at("low"), 0), high = number(target.at("high"), 0);
      if (low == 0 && high == 0) continue;
      Comparison row;
      row.name = std::string(table.name) + ", " + target.at("name").get<std::string>();
      row.unit = target.at("unit");
      row.paper = number(target.at("paper"), NAN);
      row.low = low, row.high = high;
      row.standing = Standing::kInput, row.note = table.chosen_by_it;
      const double ours = number(target.at("ours"), NAN);
      if (std::isfinite(ours)) {
        row.ours = sample_of({ours});
      } else {
        row.undefined = 1;
      }
      rows.push_back(row);
    }
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace

std::vector<Comparison> table_targets(const fs::path& campaign) {
  std::vector<Comparison> rows;
  for (const PaperTable& table : kTables) {
    const fs::path file = campaign / table.name / "result.json";
    if (fs::exists(file)) {
      add(table, file, rows);
      continue;
    }
    Comparison row;
    row.name = std::string(table.name) + ", " + table.about;
    row.paper = NAN, row.standing = Standing::kInput;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace hoof::tools
