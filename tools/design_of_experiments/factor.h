// What is varied, and between which bounds.
#pragma once

#include <string>
#include <vector>

namespace hoof::tools {

struct Factor {
  std::string name;
  double low = 0, high = 0;

  double middle() const { return 0.5 * (low + high); }
  double half() const { return 0.5 * (high - low); }
  double coded(double value) const { return (value - middle()) / half(); }
  double value(double coded) const { return middle() + coded * half(); }
};

/// "NAME=LOW:HIGH". @throws UserError naming the text and what is wrong with it
Factor parse_factor(const std::string& text);

}  // namespace hoof::tools
