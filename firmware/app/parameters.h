// Everything that may be set from outside, by name, with unit, range, default and meaning.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/control/settings.h"
#include "firmware/control/types.h"

namespace hoof::firmware::app {

/// Where a joint's absolute encoder stands. A joint that is not calibrated is not moved.
struct JointCalibration {
  float zero_rad = 0.0f;  // the drive's reading at joint angle 0
  float mark_rad = 0.0f;  // joint angle of the mark at which the joint is put to calibrate it
  float done = 0.0f;      // 0 or 1
};

/// Largest zero that is taken: half a turn, and a little for the reading's own range.
inline constexpr float kLargestZero_rad = 3.2f;

struct Parameters {
  control::Settings control;
  control::PerJoint<JointCalibration> calibration{};
  float toe_present = 1.0f;  // 0 or 1: drives that this rig has
  float leg_present = 1.0f;

  control::JointPresence presence() const { return {toe_present != 0.0f, leg_present != 0.0f}; }
  /// What the controller gets: its settings, and which joints are calibrated.
  control::Settings settings() const;
  /// Zero of the joint's readings before any homing.
  float zero_rad(control::Joint joint) const;
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

/// CRC-32 of all names, units, ranges and defaults: two programs with the same one mean the same
/// by the same place in the table.
std::uint32_t parameter_table_hash();

/// Null when there is no such parameter.
const ParameterEntry* find_parameter(std::string_view name);

enum class SetResult : std::uint8_t { kOk = 0, kUnknownName, kOutOfRange };

/// Sets one parameter; anything but kOk changes nothing. Not-a-number is out of range.
SetResult set(Parameters& parameters, std::string_view name, float value);
SetResult set(Parameters& parameters, const ParameterEntry& entry, float value);

}  // namespace hoof::firmware::app
