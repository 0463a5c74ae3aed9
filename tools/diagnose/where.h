// Where an effect shows: channels, recordings, spans of time, operating region.
#pragma once

#include <string>
#include <vector>

#include "tools/diagnose/fitter.h"
#include "tools/diagnose/verdict.h"

namespace hoof::tools {

struct Place {
  std::vector<std::string> channels;  // most telling first
  std::vector<std::string> recordings;
  std::vector<Interval> intervals;
  std::string condition;
};

/// From what the fitted model predicts with the effect and without it, all else the same.
Place place_of(const Fitter& fitter, const Fit& with, const Fit& without);

/// The mean of all samples within half of `span_s` of each.
std::vector<double> smoothed(const std::vector<double>& time_s, const std::vector<double>& values,
                             double span_s);

/// Above which an effect is said to be at work: the median of all recordings' levels, so that it is
/// half of the time at most.
double strong_bound(const std::vector<const std::vector<double>*>& levels);

/// Spans in which `level` is above the bound; gaps shorter than close_s are closed.
std::vector<std::pair<double, double>> spans_above(const std::vector<double>& time_s,
                                                   const std::vector<double>& level, double bound,
                                                   double close_s);

}  // namespace hoof::tools
