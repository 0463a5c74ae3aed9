#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hoof::tools {

/// Unit of a column or key, as its name spells it: "fx_N" -> suffix "N".
struct ColumnUnit {
  std::string_view suffix;    ///< as in the name, without the underscore: "m_s"
  std::string_view symbol;    ///< for a reader: "m/s"; empty for names that carry no unit
  std::string_view quantity;  ///< "speed"
};

/// The unit that the end of `name` spells, the longest suffix winning ("x_m_s" is m/s, not s),
/// or nullptr where it spells none.
const ColumnUnit* find_column_unit(std::string_view name);

/// `name` without its unit, underscores as blanks: "toe_torque_Nm" -> "toe torque",
/// but "grain_count" -> "grain count".
std::string column_label(std::string_view name);

/// All units that names may end in, for tests and messages.
const std::vector<ColumnUnit>& column_units();

}  // namespace hoof::tools
