// The sliding laboratory: a plate is tilted slowly under a grain that may not roll, until it
// slides.
//
// Rotation is held as a test with a flat piece or three balls in a raft holds it: by a rolling
// friction so large that no torque turns the grain. A free sphere would roll at atan(mu_r). It is
// gravity that is turned, which is the same but for what the plate's own motion does (1e-5 g at
// 5 degrees a second).
#pragma once

#include <vector>

#include "sim/config/materials.h"

namespace hoof::tools {

struct TiltTest {
  double from_rad = 0;              // where the tilting begins
  double rate_rad_s = 0.034906585;  // 2 degrees a second
  double seen_m = 1e-4;             // a grain that has slid so far is seen to slide
  int grains = 1;                   // each alone; several have the sizes of the paper's grading

  /// @throws std::invalid_argument naming the first broken rule, its value and bound
  void validate() const;
};

struct TiltOutcome {
  std::vector<double> seen_rad;   // tilt when the grain has slid by seen_m, by grain
  std::vector<double> onset_rad;  // tilt at which it began to, by grain; see tilt()
};

/// Friction and restitution are those of materials.sand_abs.
///
/// The onset is read off the recorded slide: past it the grain's acceleration grows in proportion
/// to the time since, so its slide with the cube of the tilt; the straight line through (tilt, cube
/// root of the slide) from 2 % to all of seen_m is followed back to zero.
/// @throws std::runtime_error where a grain has not slid at 80 degrees
TiltOutcome tilt(const sim::Materials& materials, const TiltTest& test);

/// The same from the flat on: tilted quickly to find where it slides, then once more at the rate
/// asked for from a few degrees below.
TiltOutcome tilt_in_two(const sim::Materials& materials, const TiltTest& test);

}  // namespace hoof::tools
