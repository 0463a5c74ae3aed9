#include "tools/diagnose/rig_keys.h"

#include <algorithm>

#include "tools/experiment/run_effects.h"

namespace hoof::tools {
namespace {

using enum Allowed;

RigKeys servo_pendulum() {
  return {
      .rig = RigKind::kServoPendulum,
      .name = "servo_pendulum",
      .channels = {"time", "position_goal", "velocity_goal", "torque_ff", "enable",
                   "supply_voltage", "position", "velocity", "current", "torque", "temperature"},
      .setup = {{"payload_mass", kNotNegative},
                {"payload_length", kPositive},
                {"arm_mass", kNotNegative},
                {"armature", kNotNegative},
                {"gravity", kNotNegative},  // zero where the link turns in a level plane
                {"coulomb", kNotNegative},
                {"viscous", kNotNegative},
                {"control_period", kPositive},
                {"kp_duty", kNotNegative},
                {"counts_per_rad", kPositive},
                {"supply_voltage", kPositive},
                {"kt", kPositive},
                {"resistance", kPositive},
                {"kp", kNotNegative},
                {"kd", kNotNegative},
                {"torque_limit", kPositive}},
      .has_law = true};
}

/// @param name of plate_sand or rigid_press: the same machine, on sand and on a block, so that one
///        [setup] can stand in both
RigKeys press(RigKind rig, const std::string& name) {
  return {.rig = rig,
          .name = name,
          .channels = {"time", "position", "force"},
          .setup = {{"diameter", kPositive},
                    {"width", kPositive},
                    {"length", kPositive},
                    {"surface_height", kAny},
                    {"k_c", kAny},  // fitted values below zero are common
                    {"k_phi", kNotNegative},
                    {"n", kPositive},
                    {"wall_distance", kPositive}}};
}

/// Numbers of the foot's plant; what is not stated is as the session's settings have it.
RigKeys foot_hil() {
  RigKeys keys{.rig = RigKind::kFootHil, .name = "foot_hil", .channels = {}, .setup = {}};
  for (const SetupNumber& number : setup_numbers()) {
    keys.setup.push_back({number.name, number.low > 0 ? kPositive : kNotNegative});
  }
  return keys;
}

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

Lack first_missing(const Setup& setup, std::initializer_list<const char*> keys,
                   const std::string& why) {
  for (const char* key : keys) {
    if (setup.find(key) == nullptr) return {key, why};
  }
  return {};
}

Lack missing_of_law(const Setup& setup, const std::vector<std::string>& channels) {
  if (setup.law == DriveLaw::kDuty) {
    const std::string why = "needed for law = \"duty\"";
    Lack lack = first_missing(setup, {"kp_duty", "counts_per_rad", "kt", "resistance"}, why);
    if (lack.name.empty() && !contains(channels, "supply_voltage")) {
      lack = first_missing(setup, {"supply_voltage"},
                           "needed where no channel supply_voltage was recorded");
    }
    return lack;
  }
  if (setup.law == DriveLaw::kImpedance) {
    Lack lack =
        first_missing(setup, {"kp", "kd", "torque_limit"}, "needed for law = \"impedance\"");
    if (lack.name.empty() && contains(channels, "current")) {
      lack = first_missing(setup, {"kt"}, "needed where the channel current was recorded");
    }
    return lack;
  }
  return {};
}

}  // namespace

const std::vector<RigKeys>& all_rig_keys() {
  static const std::vector<RigKeys> rigs = {servo_pendulum(),
                                            press(RigKind::kPlateSand, "plate_sand"),
                                            press(RigKind::kRigidPress, "rigid_press"), foot_hil()};
  return rigs;
}

const RigKeys& rig_keys(RigKind rig) {
  const auto& rigs = all_rig_keys();
  return *std::find_if(rigs.begin(), rigs.end(), [rig](const auto& r) { return r.rig == rig; });
}

std::vector<std::string> setup_key_names(const RigKeys& rig) {
  std::vector<std::string> names;
  for (const SetupKey& key : rig.setup) names.push_back(key.name);
  if (rig.has_law) names.push_back("law");
  return names;
}

const std::vector<std::string>& law_names() {
  static const std::vector<std::string> names = {"duty", "impedance", "torque"};
  return names;
}

std::string law_name(DriveLaw law) {
  return law == DriveLaw::kNone ? "" : law_names()[static_cast<std::size_t>(law) - 1];
}

DriveLaw law_of(const std::string& name) {
  const auto& names = law_names();
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? DriveLaw::kNone : DriveLaw(found - names.begin() + 1);
}

Lack find_missing_setup(RigKind rig, const Setup& setup, const std::vector<std::string>& channels) {
  if (rig == RigKind::kServoPendulum) {
    if (setup.law == DriveLaw::kNone) return {"law", "must be " + one_of(law_names())};
    const Lack lack = first_missing(setup, {"payload_mass", "payload_length"},
                                    "needed for rig = \"servo_pendulum\"");
    return lack.name.empty() ? missing_of_law(setup, channels) : lack;
  }
  if (rig != RigKind::kPlateSand) return {};
  if (setup.find("diameter") == nullptr) {
    if (setup.find("width") == nullptr) return {"diameter", "or width and length, of the plate"};
    if (setup.find("length") == nullptr) return {"length", "needed beside width"};
  }
  return first_missing(setup, {"surface_height", "k_c", "k_phi", "n"},
                       "needed for rig = \"plate_sand\"");
}

Lack find_missing_channel(RigKind rig, DriveLaw law, const std::vector<std::string>& channels) {
  std::vector<std::string> needed = rig_keys(rig).channels;  // of the presses: all
  if (rig == RigKind::kServoPendulum) {
    needed = {"time", law == DriveLaw::kTorque ? "torque" : "position_goal", "position"};
  }
  for (const std::string& channel : needed) {
    if (!contains(channels, channel)) {
      std::string why = "needed for rig = \"" + rig_keys(rig).name + "\"";
      if (channel == "torque" || channel == "position_goal") {
        why += ", law = \"" + law_name(law) + "\"";
      }
      return {channel, why};
    }
  }
  return {};
}

}  // namespace hoof::tools
