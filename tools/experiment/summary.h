// result.json of a sinkage or traction run.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hil_bridge/session.h"
#include "tools/experiment/recorder.h"
#include "tools/experiment/run_settings.h"

namespace hoof::tools {

/// Peak of the propulsive force and the vertical force at that instant, both as moving means over
/// kPeakWindow ticks: single grains that let go make spikes of a millisecond.
struct TractionPeaks {
  static constexpr int kPeakWindow_ticks = 11;

  double fx_peak_N = 0;
  double fz_at_fx_peak_N = 0;
  double fz_peak_N = 0;
  double fx_peak_time_s = 0;

  /// The paper's: Fx at its peak over Fz at the same instant; NaN where nothing carries the foot
  /// then.
  double traction_coefficient() const {
    return fz_at_fx_peak_N > 0 ? fx_peak_N / fz_at_fx_peak_N : std::nan("");
  }
};

/// One line for the user: which fast soil a run was on, and how far it is from what it was fitted
/// to.
std::string soil_line(const RunSettings& run);

TractionPeaks find_peaks(const std::vector<ForceSample>& forces);

/// Holds nothing that differs between two runs of the same command: no wall time, no date.
nlohmann::ordered_json summarise(const RunSettings& run, const sim::Experiment& experiment,
                                 const bridge::SessionResult& session, const Recorder& recorder);

/// What became of the faults that were put in, for people; nothing where there were none.
void print_faults(const nlohmann::ordered_json& result);

}  // namespace hoof::tools
