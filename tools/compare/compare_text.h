// A comparison for readers: a table in the terminal, a page.
#pragma once

#include <ostream>
#include <string>

#include "tools/compare/comparison.h"

namespace hoof::tools {

/// Names of the two, as the user gave them.
struct ComparedNames {
  std::string a, b;
};

void print_comparison(const Comparison& comparison, const ComparedNames& names, std::ostream& out);

/// Self-contained: verdicts, and each signal of both over one another, the worst first.
std::string comparison_page(const Comparison& comparison, const ComparedNames& names);

}  // namespace hoof::tools
