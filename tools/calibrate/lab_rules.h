// One line for a setting that is out of its bounds.
#pragma once

#include <cstdio>
#include <stdexcept>
#include <string>

namespace hoof::tools {

/// @throws std::invalid_argument naming the flag, its value and its bounds
inline void require_within(const std::string& flag, double value, double low, double high,
                           const std::string& unit) {
  if (value >= low && value <= high) return;  // a NaN is out
  const char* blank = unit.empty() ? "" : " ";
  char text[200];
  std::snprintf(text, sizeof text, "--%s = %g%s%s, must be from %g to %g%s%s", flag.c_str(), value,
                blank, unit.c_str(), low, high, blank, unit.c_str());
  throw std::invalid_argument(text);
}

}  // namespace hoof::tools
