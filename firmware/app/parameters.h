// Everything that may be set from outside, by name, with unit, range, default and meaning.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/control/settings.h"
#include "firmware/control/types.h"

namespace hoof::firmware::app {

struct Parameters {
  control::Settings control;
  float toe_present = 1.0f;  // 0 or 1: drives that this rig has
  float leg_present = 1.0f;

  control::JointPresence presence() const { return {toe_present != 0.0f, leg_present != 0.0f}; }
};

struct ParameterEntry {
  std::string_view name;  // ends in its unit
  std::string_view unit;
  float minimum;
  float maximum;
  float& (*value)(Parameters&);
  std::string_view description;

  float default_value() const {
    Parameters defaults;
    return value(defaults);
  }
};

std::span<const ParameterEntry> parameter_table();

/// Null when there is no such parameter.
const ParameterEntry* find_parameter(std::string_view name);

enum class SetResult : std::uint8_t { kOk = 0, kUnknownName, kOutOfRange };

/// Sets one parameter; anything but kOk changes nothing. Not-a-number is out of range.
SetResult set(Parameters& parameters, std::string_view name, float value);

}  // namespace hoof::firmware::app
