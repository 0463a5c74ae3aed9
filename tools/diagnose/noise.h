// Noise of a recorded channel, told from the signal by its not being smooth.
#pragma once

#include <span>
#include <vector>

namespace hoof::tools {

/// 1-sigma of what a cubic through seven neighbouring samples leaves, robust (median); no less than
/// the resolution's own 1/sqrt(12). 0 where there are too few samples.
double estimate_noise(std::span<const double> time_s, std::span<const double> values);

/// Smallest step between two values that differ: the resolution, where there is one.
double resolution(std::span<const double> values);

/// Weighted slope at the start over `span_s`.
double first_slope(std::span<const double> time_s, std::span<const double> values, double span_s);

/// Slope at each sample by a straight line through all within `span_s` of it; NaN where none are.
std::vector<double> slopes(std::span<const double> time_s, std::span<const double> values,
                           double span_s);

/// The values less their noise where they are smooth: a parabola through `span` neighbours (odd)
/// stands in for the middle one where it leaves no more than the noise; elsewhere they stay. The
/// values themselves where the span is less than five.
std::vector<double> without_noise(std::span<const double> time_s, std::span<const double> values,
                                  std::size_t span);

double rms(std::span<const double> values);

}  // namespace hoof::tools
