// How far a signal may be off.
#pragma once

#include <string>
#include <vector>

#include "tools/log/signal_series.h"

namespace hoof::tools {

/// A value may be off by max(absolute, relative x |baseline at that moment|).
struct Tolerance {
  double absolute = 0;  // in the signal's own SI unit
  double relative = 0;

  double at(double baseline) const;
};

/// By the unit that the name ends in; nothing for whole numbers, texts and names without unit.
Tolerance default_tolerance(const SignalSeries& series);

/// "PATTERN=ABSOLUTE" or "PATTERN=ABSOLUTE,RELATIVE", SI; * stands for any characters.
struct ToleranceRule {
  std::string pattern;
  Tolerance tolerance;
};

/// @throws UserError saying what is wrong with the text
ToleranceRule parse_tolerance_rule(const std::string& text);

/// The last rule that matches the signal's name, else its default.
Tolerance tolerance_of(const SignalSeries& series, const std::vector<ToleranceRule>& rules);

}  // namespace hoof::tools
