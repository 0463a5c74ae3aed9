// What the firmware made of a fault, seen from the rig: when it told a fault, from when on no drive
// pushed, and whether a reset brought it back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "firmware/app/telemetry.h"
#include "sim/coupling/plant.h"

namespace hoof::bridge {

struct Reaction {
  std::uint32_t faults = 0;         // all bits since the first fault began, by heartbeat's names
  std::optional<double> tripped_s;  // when the first one was latched
  std::optional<double> safe_s;     // from when on all drives were off or damping, until the end
  std::optional<double> reset_s;    // off again without a fault, after a reset
  std::string mode;                 // at the end
};

/// "drive_lost, bus_off"
std::string fault_bit_names(std::uint32_t faults);
std::string mode_name(int mode);

/// True where no drive can push by itself: off, without fresh commands, or damping only.
bool all_passive(const sim::Plant& plant);

class ReactionWatch {
 public:
  /// After every tick from the first fault on.
  void note(double now_s, const sim::Plant& plant, firmware::control::Mode mode,
            std::uint32_t faults);
  /// The reset worked, now.
  void note_reset(double now_s) { reaction_.reset_s = now_s; }
  const Reaction& reaction() const { return reaction_; }

 private:
  Reaction reaction_;
};

}  // namespace hoof::bridge
