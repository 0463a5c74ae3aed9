// An experiment that is yet to be made: what to play, and what each hypothesis says of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/data_set.h"

namespace hoof::tools {

/// What one of the hypotheses in question expects.
struct ExpectedOutcome {
  std::string hypothesis;  // "supply_sag", "backlash+stribeck_friction", "none"
  /// By channel, one value per sample of the recording, SI.
  std::map<std::string, std::vector<double>> predicted;
  /// 1-sigma of that from what the recordings leave open of the hypothesis' numbers.
  std::map<std::string, std::vector<double>> spread;
  /// Of the telling reading: value, and 1-sigma of spread and noise, SI.
  double reading = 0, reading_sigma = 0;
};

/// What an engineer can read off the recording: the mean of a channel over a span, or by how much
/// that changes from an earlier span.
struct TellingReading {
  std::string channel;
  double from_s = 0, to_s = 0;  // the same: one sample
  bool change = false;
  double earlier_from_s = 0, earlier_to_s = 0;
  double sigmas = 0;  // of noise and spread, between the pair that is told apart worst
};

struct PlannedExperiment {
  std::string action;  // "hold 9 angles from -0.8 to 0.8 rad, ..."
  /// One recording, planned, with the inputs to play; named as the file that is to be recorded.
  DataSet set;
  std::vector<ExpectedOutcome> outcomes;     // the most probable hypothesis first
  std::map<std::string, double> noise;       // 1-sigma by channel, as in the recordings, SI
  std::vector<std::string> input_channels;   // of the recording: to play
  std::vector<std::string> output_channels;  // to record
  TellingReading telling;

  /// How far apart that pair is over the whole experiment, in sigmas of noise and of what both
  /// hypotheses' numbers may still be; and the odds between them that are to be expected, as the
  /// judge counts evidence.
  double sigmas = 0, log10_odds = 0;
  /// The same of the best of the recordings given, made once more.
  double again_sigmas = 0;
  /// No value can be read off: noise of the torque carries the machine away from any prediction,
  /// and predictions here are drawn to the goal as those that are fitted are to what was measured.
  bool open_loop = false;
  int looked_at = 0;  // experiments that were simulated
};

}  // namespace hoof::tools
