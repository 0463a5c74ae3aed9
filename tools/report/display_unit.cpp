#include "tools/report/display_unit.h"

#include <charconv>
#include <numbers>

#include "tools/run/column_unit.h"

namespace hoof::tools {

DisplayUnit display_unit(std::string_view name) {
  const ColumnUnit* unit = find_column_unit(name);
  if (unit == nullptr) return {};
  const std::string quantity(unit->quantity);
  if (unit->suffix == "m") return {1000.0, "mm", quantity};
  if (unit->suffix == "rad") return {180.0 / std::numbers::pi, "°", quantity};
  if (unit->suffix == "ratio") return {100.0, "%", quantity};
  if (unit->suffix == "count") return {1.0, "", quantity};
  return {1.0, std::string(unit->symbol), quantity};
}

std::string format_significant(double value, int digits) {
  char text[32];  // sign, point, up to 17 digits and an exponent
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits);
  return std::string(text, end);
}

}  // namespace hoof::tools
