// From fits to probabilities: none, unknown, every effect, pairs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/search.h"

namespace hoof::tools {

/// Evidence is counted down by this: samples that look independent share one model's errors, and
/// a fitted integrator is not the plant. From the calibration on concealed plants (README.md).
inline constexpr double kTemperature = 3.0;
/// No model is the plant: this much log likelihood per independent sample proves nothing.
inline constexpr double kTolerated = 0.0025;

/// What a hypothesis achieved, relative to the nominal model.
struct Standing {
  const Fit* fit = nullptr;
  bool listed = true;       // no stand-in for unlisted physics
  double evidence = 0;      // log evidence of the fit recordings
  double holdout_gain = 0;  // log predictive density of the held-out ones
  double explained = 0;  // share of the log likelihood between nominal and bare noise; 1: all of it
  /// Of the order (autocorrelation) in what the nominal model leaves, the share that this leaves.
  double left = 0;
  /// Of held-out recordings, the mean logarithm by which its errors are smaller than the nominal's.
  double foretold = 0;
  double insufficient = 0;  // probability that something beside the list is at work
  double probability = 0;
};

struct Judgement {
  std::vector<Standing> standings;          // the most probable first
  double none = 0, unknown = 0;             // probabilities
  std::map<std::string, double> marginals;  // of each listed effect
  /// Log likelihood that lies between the nominal model and bare noise, per sample.
  double misfit = 0;
};

Judgement judge(const Fitter& fitter, const SearchResult& result);

}  // namespace hoof::tools
