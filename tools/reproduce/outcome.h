// What a finished run of a campaign gave.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hoof::tools {

/// Forces on the foot in a stance, means over kStep_s each, the first from first contact on.
struct ForceTrace {
  static constexpr double kStep_s = 0.010;
  std::vector<double> fx_N, fz_N;
};

/// Of the other kind: zero.
struct Outcome {
  double sinkage_mm = 0;       // largest displacement since first contact, spines count
  double sole_sinkage_mm = 0;  // the sole below the height of first contact then
  /// Of the sand at the greatest depth (tools/fields), NaN where a run kept none of it: the share
  /// of the plantar area with high pressure; the area of sand that carries over that of the foot;
  /// the stress under the gap between the toes over that under the foot.
  double high_pressure_share = kNone, support_area_ratio = kNone, gap_stress_ratio = kNone;
  double fx_peak_N = 0, fz_at_fx_peak_N = 0;  // at that instant
  double coefficient = 0;                     // NaN where nothing carries the foot then
  double fx_peak_s = 0;                       // since first contact
  /// The greatest local maximum of Fx before that peak that stands out by kEarly of the peak from
  /// the valley between the two: its force over the peak's, its time; zero where there is none.
  double early_ratio = 0, early_s = 0;
  /// As many grains the paper's box would hold, filled as its own, at the solid share of this whole
  /// bed, in grains of the paper's size; NaN where there are none, as on fast soil.
  double grains_in_papers_box = kNone;
  std::vector<std::string> refused = {};  // what its bed cannot tell, sim/experiments/resolution.h
  ForceTrace trace = {};

  static constexpr double kEarly = 0.05;
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

/// By condition, then by bed.
using Outcomes = std::map<std::string, std::map<int, Outcome>>;

/// The same read otherwise: depth is how far the sole is in the sand, 0 where it hangs above, not
/// how far the spines went since they touched. The paper does not say which it means.
Outcomes read_by_sole(const Outcomes& outcomes);

/// @param traction its kind  @param folder of the run, with result.json, settings.toml and samples.csv
/// @throws UserError where they do not read
Outcome read_outcome(bool traction, const std::filesystem::path& folder);

/// Fills fx_peak_s and the early peak from the trace.
void find_timing(Outcome& outcome);

}  // namespace hoof::tools
