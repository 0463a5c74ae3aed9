#include "tools/calibrate/reduction.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hoof::tools {

double mean_of(const std::vector<double>& values) {
  if (values.empty()) throw std::invalid_argument("a mean needs a value");
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(values.size());
}

double binned_mean(const std::vector<double>& values, double bin_width) {
  if (!(bin_width > 0)) throw std::invalid_argument("a bin needs a width above 0");
  std::vector<double> middles;
  for (const double v : values) middles.push_back((std::floor(v / bin_width) + 0.5) * bin_width);
  return mean_of(middles);
}

Quadratic fit_quadratic(const std::vector<PaperRow>& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd terms(n, 3);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PaperRow& row = rows[static_cast<std::size_t>(i)];
    terms.row(i) << row.x * row.x, row.x, 1;
    y[i] = row.y;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(terms);
  if (n < 3 || qr.rank() < 3) throw std::invalid_argument("a quadratic needs three different x");
  const Eigen::VectorXd c = qr.solve(y);
  return {c[0], c[1], c[2]};
}

double at(const Quadratic& c, double x) {
  return (c[0] * x + c[1]) * x + c[2];
}

double root_of(const Quadratic& c, double y, double low, double high) {
  if ((at(c, low) < y) == (at(c, high) < y)) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((at(c, middle) < y) == (at(c, low) < y) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double rms_to(const std::vector<PaperRow>& rows, const std::function<double(double)>& of) {
  double sum = 0;
  for (const PaperRow& row : rows) sum += std::pow(row.y - of(row.x), 2);
  return std::sqrt(sum / double(rows.size()));
}

}  // namespace hoof::tools
