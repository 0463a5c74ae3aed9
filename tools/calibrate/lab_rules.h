// One line for a setting that is out of its bounds.
#pragma once

#include <stdexcept>
#include <string>

#include "tools/run/csv_writer.h"

namespace hoof::tools {

/// @throws std::invalid_argument naming the flag, its value and its bounds
inline void require_within(const std::string& flag, double value, double low, double high,
                           const std::string& unit) {
  if (value >= low && value <= high) return;  // a NaN is out
  const std::string of = unit.empty() ? "" : " " + unit;
  throw std::invalid_argument("--" + flag + " = " + format_number(value) + of + ", must be from " +
                              format_number(low) + " to " + format_number(high) + of);
}

}  // namespace hoof::tools
