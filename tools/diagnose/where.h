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

/// Spans in which `strength`, smoothed over `smooth_s`, is above its median and above a fifth of
/// its top; gaps shorter than smooth_s closed.
std::vector<std::pair<double, double>> strong_spans(const std::vector<double>& time_s,
                                                    const std::vector<double>& strength,
                                                    double smooth_s);

}  // namespace hoof::tools
