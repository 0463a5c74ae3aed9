// One cell of the matrix while it runs: the foot stands in its mode, a fault comes, and what
// follows is measured.
#pragma once

#include <array>
#include <cstdint>

#include "tools/faults/matrix_cases.h"
#include "tools/faults/matrix_foot.h"

namespace hoof::tools {

using JointTorques = std::array<double, sim::kJointCount>;

/// What a cell's process hands back: plain numbers. Times count from the begin of the fault.
struct Measured {
  std::uint32_t faults = 0;  // bits that were not there before
  double began_s = 0;
  double trip_s = -1;         // to the first bit; below 0: never
  double safe_s = -1;         // until no drive pushed any more, for good; below 0: never
  double surge_s = 0;         // for which a drive pushed more than it ever should
  JointTorques push_Nm{};     // largest torque of each motor along its own motion
  std::uint64_t changed = 0;  // by the fault
  int end_mode = 0;
  bool reset = false;
  bool moves = false;
};

bool moving(firmware::control::Mode mode);
/// Neither moving nor about to come to rest.
bool at_rest(firmware::control::Mode mode);

/// The same time without any fault: what each motor needs.
JointTorques measure_undisturbed(MatrixFoot& foot);

/// @param undisturbed torques of measure_undisturbed() from the same moment on
Measured measure(MatrixFoot& foot, const MatrixCase& c, const JointTorques& undisturbed);

}  // namespace hoof::tools
