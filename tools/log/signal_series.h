// Signals as curves over time, from a bus log or from the samples of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/log/bus_recording.h"

namespace hoof::tools {

struct SignalSeries {
  std::string name;    // "ToeReply.position_rad", or the column "toe_measured_rad"
  bool whole = false;  // counts, names or bits: holds its value, knows no tolerance
  std::vector<double> time_s;
  std::vector<double> values;
  std::vector<std::string> value_names;  // of a text column: value n is this text
};

/// Signals of the dictionary that occur and match a pattern; drive commands that are switches, and
/// frames that do not read, have no values. SYNC counts once, on bus 0.
/// @param patterns empty: all
std::vector<SignalSeries> series_of(const BusRecording& recording,
                                    const std::vector<std::string>& patterns);

/// Columns of samples.csv but time_s; texts as numbers of their names.
std::vector<SignalSeries> series_of_samples(const std::filesystem::path& samples_csv,
                                            const std::vector<std::string>& patterns);

}  // namespace hoof::tools
