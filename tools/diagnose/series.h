// Numbers of a series of samples, NaN where one is missing; noise and resolution are in noise.h.
#pragma once

#include <vector>

namespace hoof::tools {

using Series = std::vector<double>;

/// Without the missing samples.
Series valid_of(const Series& values);

/// Quantile 0..1 of the valid samples, NaN of none.
double quantile(const Series& values, double share);
double median(const Series& values);

/// Largest less smallest; 0 of none.
double range_of(const Series& values);

/// Standard deviation about the mean.
double deviation(const Series& values);

/// Slope at each sample of the line fitted to those within half_window_s of it, and at least two
/// steps of time (see slopes in noise.h).
Series derivative(const Series& time_s, const Series& values, double half_window_s);

/// Correlation of a with b, and a / b in the sense of least squares with both uncertain (the
/// principal axis of scaled data): sign(r) sd(a) / sd(b). Pairs with a missing sample are left
/// out; r is 0 where one of them does not move.
struct Relation {
  double r = 0;
  double ratio = 0;
  int count = 0;
};
Relation relate(const Series& a, const Series& b);
/// a[i + shift] with b[i].
Relation relate_shifted(const Series& a, const Series& b, int shift);

}  // namespace hoof::tools
