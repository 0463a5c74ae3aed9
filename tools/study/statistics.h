// Means over a few bed preparations, and how far they can be trusted.
#pragma once

#include <cstddef>
#include <vector>

namespace hoof::tools {

struct Sample {
  std::size_t n = 0;
  double mean = 0;
  double deviation = 0;  // standard deviation of one value, n - 1 in the divisor; NaN for n = 1
  double standard_error = 0;  // of the mean
  /// Half of the 95 % confidence interval of the mean (Student's t): a true difference from 1 that
  /// is smaller would not show.
  double confidence = 0;
  std::size_t above_one = 0;  // values over 1
};

/// Values that are NaN (a run that blew up or did not get there) are left out.
Sample sample_of(const std::vector<double>& values);

/// Spearman's rank correlation, equal values at their mean rank: 1 where one list rises with the
/// other, -1 where it falls. NaN where a list is constant, or of fewer than two values.
/// @throws std::invalid_argument where the lists are not of one length
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Kendall's (Biometrika 30 (1938) 81): pairs in the same order less those in the other one, over
/// all; over the pairs that are not equal in either list (tau-b). NaN where a list is constant.
/// @throws std::invalid_argument where the lists are not of one length
double kendall_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// 97.5 % quantile of Student's t for the degrees of freedom; above 10 that of 10, which is larger.
double student_t_975(std::size_t degrees);

}  // namespace hoof::tools
