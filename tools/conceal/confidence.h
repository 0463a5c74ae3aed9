#pragma once

#include <vector>

namespace hoof::tools::conceal {

struct Bounds {
  double low = 0.0, high = 1.0;
};

/// 95 % interval of a share of which `good` in `count` were seen (Clopper and Pearson 1934).
Bounds clopper_pearson(int good, int count);

/// 95 % interval of the mean of values (Student); -inf to inf below two of them.
Bounds mean_bounds(const std::vector<double>& values);

double mean_of(const std::vector<double>& values);

}  // namespace hoof::tools::conceal
