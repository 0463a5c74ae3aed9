#include "hil_bridge/reaction.h"

#include "firmware/protocol/dictionary.h"

namespace hoof::bridge {
namespace {

/// The code next to zero, half a step off, and a tenth for rounding: what "none" is on the wire.
constexpr double half_step(float range) {
  constexpr double kCodes = 4095;  // of 12 bits, from -range to range
  return 1.1 * double(range) / kCodes;
}

}  // namespace

std::string fault_bit_names(std::uint32_t faults) {
  std::string text;
  for (const firmware::protocol::ValueName& name : firmware::protocol::kFaultBitNames) {
    if ((faults >> name.value & 1) == 0) continue;
    text += (text.empty() ? "" : ", ") + std::string(name.name);
  }
  return text;
}

std::string mode_name(int mode) {
  for (const firmware::protocol::ValueName& name : firmware::protocol::kModeNames) {
    if (int(name.value) == mode) return std::string(name.name);
  }
  return std::to_string(mode);
}

bool all_passive(const sim::Plant& plant) {
  for (int j = 0; j < sim::kJointCount; ++j) {
    const sim::Drive* drive = plant.drive(sim::Joint(j));
    const firmware::protocol::DriveRange& range = firmware::protocol::kDriveRanges[std::size_t(j)];
    if (drive && !drive->passive(half_step(range.torque_Nm), half_step(range.velocity_rad_s))) {
      return false;
    }
  }
  return true;
}

void ReactionWatch::note(double now_s, const sim::Plant& plant, firmware::control::Mode mode,
                         std::uint32_t faults) {
  reaction_.faults |= faults;
  if (faults != 0 && !reaction_.tripped_s) reaction_.tripped_s = now_s;
  if (!all_passive(plant)) {
    reaction_.safe_s.reset();
  } else if (!reaction_.safe_s) {
    reaction_.safe_s = now_s;
  }
  reaction_.mode = mode_name(int(mode));
}

}  // namespace hoof::bridge
