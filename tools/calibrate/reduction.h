// From many grains to one number, as the source paper does it, and from a curve to a coefficient.
#pragma once

#include <functional>
#include <vector>

#include "tools/calibrate/paper_tables.h"

namespace hoof::tools {

/// Mean of the values after each was moved to the middle of its bin [i w, (i + 1) w): the paper's
/// weighted mean over bins of w. The bins alone put an error of w / sqrt(12) on each value.
/// @throws std::invalid_argument where there is no value or a bin has no width
double binned_mean(const std::vector<double>& values, double bin_width);

double mean_of(const std::vector<double>& values);

/// Least squares fit of y by c[0] x^2 + c[1] x + c[2].
/// @throws std::invalid_argument where fewer than three different x are given
Quadratic fit_quadratic(const std::vector<PaperRow>& rows);

double at(const Quadratic& c, double x);

/// Where the quadratic is y, between low and high; NaN where it is not, or twice.
double root_of(const Quadratic& c, double y, double low, double high);

/// Root mean square of y - of(x).
double rms_to(const std::vector<PaperRow>& rows, const std::function<double(double)>& of);

}  // namespace hoof::tools
