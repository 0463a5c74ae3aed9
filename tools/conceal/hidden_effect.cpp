#include "tools/conceal/hidden_effect.h"

#include <algorithm>
#include <stdexcept>

namespace hoof::tools::conceal {

EffectParameter& HiddenEffect::find(const std::string& parameter) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(),
                   [&parameter](const EffectParameter& p) { return p.name == parameter; });
  if (found == parameters.end()) throw std::logic_error(name + " has no parameter " + parameter);
  return *found;
}

double HiddenEffect::at(const std::string& parameter) const {
  return const_cast<HiddenEffect*>(this)->find(parameter).value;
}

}  // namespace hoof::tools::conceal
