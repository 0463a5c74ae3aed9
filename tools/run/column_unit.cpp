#include "tools/run/column_unit.h"

#include <algorithm>

namespace hoof::tools {

const std::vector<ColumnUnit>& column_units() {
  static const std::vector<ColumnUnit> units = {
      {"m", "m", "length"},
      {"mm", "mm", "length"},
      {"m2", "m²", "area"},
      {"m3", "m³", "volume"},
      {"rad", "rad", "angle"},
      {"deg", "°", "angle"},
      {"s", "s", "time"},
      {"us", "µs", "time"},
      {"Hz", "Hz", "frequency"},
      {"m_s", "m/s", "speed"},
      {"m_s2", "m/s²", "acceleration"},
      {"rad_s", "rad/s", "angular speed"},
      {"rad_s2", "rad/s²", "angular acceleration"},
      {"kg", "kg", "mass"},
      {"kg_m2", "kg m²", "moment of inertia"},
      {"kg_m3", "kg/m³", "density"},
      {"N", "N", "force"},
      {"N_m", "N/m", "stiffness"},
      {"N_s_m", "N s/m", "damping"},
      {"Nm", "N m", "torque"},
      {"Nm_rad", "N m/rad", "angular stiffness"},
      {"Nm_s_rad", "N m s/rad", "angular damping"},
      {"Nm_s", "N m/s", "torque rate"},
      {"J", "J", "energy"},
      {"W", "W", "power"},
      {"Pa", "Pa", "pressure"},
      {"A", "A", "current"},
      {"V", "V", "voltage"},
      {"Nm_A", "N m/A", "torque constant"},
      {"degC", "°C", "temperature"},
      {"bit_s", "bit/s", "bit rate"},
      {"bytes", "bytes", "size"},
      {"ratio", "1", "ratio"},
      {"count", "1", "count"},
      {"name", "", "name"},
  };
  return units;
}

const ColumnUnit* find_column_unit(std::string_view name) {
  const ColumnUnit* best = nullptr;
  for (const ColumnUnit& unit : column_units()) {
    // The unit alone is no name: "_N" must follow something.
    if (name.size() < unit.suffix.size() + 2 || !name.ends_with(unit.suffix)) continue;
    if (name[name.size() - unit.suffix.size() - 1] != '_') continue;
    if (best == nullptr || unit.suffix.size() > best->suffix.size()) best = &unit;
  }
  return best;
}

std::string column_label(std::string_view name) {
  const ColumnUnit* unit = find_column_unit(name);
  // "grain count" needs its last word, "depth" does not need "metres".
  const bool whole = unit == nullptr || unit->suffix == "count";
  std::string label(whole ? name : name.substr(0, name.size() - unit->suffix.size() - 1));
  std::replace(label.begin(), label.end(), '_', ' ');
  return label;
}

}  // namespace hoof::tools
