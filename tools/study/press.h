// One run of a study: an indenter goes straight down into a settled bed at constant speed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/terrain/bed_maker.h"
#include "tools/study/indenter.h"

namespace hoof::tools {

struct PressCase {
  sim::BedSettings bed;
  std::uint64_t seed = 1;  // of the bed's preparation; nothing else is random
  Indenter indenter;
  double offset_x_m = 0;  // of the indenter's middle
  double speed_m_s = 0.1;
  double depth_m = 13.5e-3;    // of the sole below the level sand, where the run ends
  std::optional<double> dt_s;  // another step than the bed was made with
  double cell_m = 0;           // of the neighbour search; 0: the engine's own choice
  /// Walls, floor and indenter without friction: what a mirror plane needs, since the engine has
  /// one friction for all of them.
  bool smooth = false;

  double step_s() const { return dt_s.value_or(bed.step_s()); }
  /// "strip-plain 2.1x 160x90x100 seed 3"
  std::string name() const;
  /// Everything that decides the result, in one line.
  std::string key(const sim::Materials& materials) const;
  /// Steps from first contact to the end.
  double steps() const;
};

struct PressSample {
  double depth_m = 0;        // of the sole below the level sand, in the middle of the interval
  double force_N = 0;        // upward, mean over the interval; NaN where the bed blew up
  double fastest_m_s = 0;    // grain, at the end of the interval
  double overlap_ratio = 0;  // with walls and indenter over grain radius, so far
  double rebuild_count = 0;  // of neighbour lists, so far
  double wall_s = 0;         // taken so far on this machine
};

struct PressCurve {
  std::vector<PressSample> samples;
  std::string blow_up;  // the engine's words where the bed blew up; empty else
  double grain_count = 0;
  double solid_share = 0;  // of the bed before it was pressed

  /// Mean force while the sole is within half_window_m of a depth; NaN where the run does not
  /// reach.
  double force_at_N(double depth_m, double half_window_m = 0.5e-3) const;
};

/// @param progress called with the share done; returns false to stop
/// @throws std::runtime_error "stopped"; a blow-up is a result and does not throw
PressCurve press(const PressCase& c, const sim::Materials& materials, const sim::BedState& bed,
                 int threads, const sim::BedProgress& progress);

/// Through a temporary file: the file is whole or not there.
void write_curve(const std::filesystem::path& file, const PressCurve& curve);
/// @throws UserError naming file and line
PressCurve read_curve(const std::filesystem::path& file);

}  // namespace hoof::tools
