#pragma once

#include <string>
#include <vector>

namespace hoof::tools::conceal {

/// One number of an effect, by the contract's name and unit.
struct EffectParameter {
  std::string name;
  double value;
  std::string unit;
  /// The period where the number is an angle that goes round, else 0.
  double period = 0.0;
  /// Other values that the contract's words allow as well (README.md, "Words that can be read in
  /// two ways"): an interval that holds one of them holds the truth.
  std::vector<double> other_readings = {};
};

/// What a case hides: an effect of the contract's section 4, or one that is not listed there.
struct HiddenEffect {
  std::string name;
  bool listed = true;
  std::vector<EffectParameter> parameters;

  double at(const std::string& parameter) const;
  EffectParameter& find(const std::string& parameter);
};

}  // namespace hoof::tools::conceal
