#pragma once

#include <string>
#include <string_view>

namespace hoof::tools {

/// How a quantity is shown to a reader: files hold SI, readers think in millimetres and degrees.
struct DisplayUnit {
  double factor = 1.0;   ///< shown value = factor * value
  std::string symbol;    ///< unit of the shown value; empty for none
  std::string quantity;  ///< "length"; empty where the name spells no unit
};

/// For the unit that `name` ends in (tools/run/column_unit.h).
DisplayUnit display_unit(std::string_view name);

/// `value` with `digits` significant digits, without an exponent where it can be avoided.
std::string format_significant(double value, int digits);

}  // namespace hoof::tools
