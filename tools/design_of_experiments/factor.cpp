#include "tools/design_of_experiments/factor.h"

#include <charconv>
#include <cmath>

#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

double number(const std::string& text, const std::string& whole) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UserError("factor \"" + whole + "\": \"" + text + "\" is no number");
  }
  return value;
}

}  // namespace

Factor parse_factor(const std::string& text) {
  const std::size_t equals = text.find('='), colon = text.find(':', equals + 1);
  if (equals == 0 || equals == std::string::npos || colon == std::string::npos) {
    throw UserError("factor \"" + text + "\": write NAME=LOW:HIGH, e.g. mu_s=0.2:0.9");
  }
  Factor factor{text.substr(0, equals), number(text.substr(equals + 1, colon - equals - 1), text),
                number(text.substr(colon + 1), text)};
  if (!(factor.low < factor.high)) {
    throw UserError("factor \"" + text + "\": the low bound must be below the high one");
  }
  return factor;
}

}  // namespace hoof::tools
