// What is put in, in every mode, and what has to come of it.
#pragma once

#include <string>
#include <vector>

#include "firmware/control/types.h"
#include "hil_bridge/fault_spec.h"

namespace hoof::tools {

/// What one cell must show. Times count from the begin of the fault.
struct Expectation {
  /// Any of these bits, and no other; 0: harmless, no bit at all and the mode goes on.
  std::uint32_t bits = 0;
  /// By then no drive pushes, for good. Nothing is asked of a harmless fault of a moving foot.
  double safe_s = 0;
  /// In this mode there may be nothing for the fault to change, such as the torque of a drive that
  /// is off; then it must be harmless.
  bool idle = false;
  /// So long a drive may push more than a quarter of the gate's ceiling harder than it ever does
  /// without the fault. Zero but where the drive's own law acts on its own wrong encoder, or on a
  /// command that nobody gave.
  double surge_s = 0;

  /// The foot does what it did before.
  bool goes_on(firmware::control::Mode mode) const;
};

struct MatrixCase {
  std::string name;
  bridge::FaultSpec fault;
  Expectation moving;    // in homing, ready, running
  Expectation stopping;  // in damped stop
  Expectation idle;      // in off, fault, emergency off
  /// Modes for which something else holds.
  std::vector<std::pair<firmware::control::Mode, Expectation>> except;
  std::string why;   // where the expectation needs a reason; told in the table
  bool gap = false;  // known not to be met everywhere; `why` says what is in the way

  const Expectation& expected(firmware::control::Mode mode) const;
};

std::vector<MatrixCase> matrix_cases();

}  // namespace hoof::tools
