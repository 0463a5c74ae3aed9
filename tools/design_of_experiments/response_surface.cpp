#include "tools/design_of_experiments/response_surface.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <map>

#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Two runs whose coded factors differ by no more are one run, repeated.
constexpr double kSame = 1e-9;

VarianceRow variance_row(const std::string& source, double squares, int freedom, double error,
                         int error_freedom) {
  VarianceRow row{source, squares, freedom, freedom > 0 ? squares / freedom : kNone, kNone, kNone};
  if (freedom > 0 && error_freedom > 0 && error > 0) {
    row.f = row.mean_square / error;
    const boost::math::fisher_f distribution(freedom, error_freedom);
    row.p = boost::math::cdf(boost::math::complement(distribution, std::max(row.f, 0.0)));
  }
  return row;
}

/// Sum of squares about the means of runs that were repeated, and its freedom.
VarianceRow pure_error(const std::vector<std::vector<double>>& coded, const Eigen::VectorXd& y) {
  VarianceRow row{"pure error", 0, 0, kNone, kNone, kNone};
  std::vector<bool> taken(coded.size(), false);
  for (std::size_t i = 0; i < coded.size(); ++i) {
    if (taken[i]) continue;
    std::vector<double> same;
    for (std::size_t j = i; j < coded.size(); ++j) {
      bool equal = !taken[j];
      for (std::size_t f = 0; f < coded[i].size(); ++f) {
        equal = equal && std::abs(coded[i][f] - coded[j][f]) < kSame;
      }
      if (!equal) continue;
      taken[j] = true;
      same.push_back(y[static_cast<Eigen::Index>(j)]);
    }
    double mean = 0;
    for (const double v : same) mean += v / static_cast<double>(same.size());
    for (const double v : same) row.sum_of_squares += (v - mean) * (v - mean);
    row.freedom += static_cast<int>(same.size()) - 1;
  }
  if (row.freedom > 0) row.mean_square = row.sum_of_squares / row.freedom;
  return row;
}

}  // namespace

ResponseSurface::ResponseSurface(std::vector<Factor> factors, const Runs& runs, SurfaceModel model)
    : factors_(std::move(factors)), model_(model) {
  name_terms();
  const auto n = static_cast<Eigen::Index>(runs.factors.size());
  const auto k = static_cast<Eigen::Index>(terms_.size());
  if (n < k) {
    throw UserError(runs.source + ": " + std::to_string(n) + " runs cannot tell " +
                    std::to_string(k) + " terms");
  }
  Eigen::MatrixXd X(n, k);
  Eigen::VectorXd y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double> coded;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      coded.push_back(factors_[f].coded(runs.factors[static_cast<std::size_t>(i)][f]));
    }
    X.row(i) = row(coded).transpose();
    y[i] = runs.response[static_cast<std::size_t>(i)];
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(X);
  if (qr.rank() < k) {
    const auto open = qr.colsPermutation().indices()[qr.rank()];
    throw UserError(runs.source + ": these runs leave the term " +
                    terms_[static_cast<std::size_t>(open)] + " open");
  }
  coded_ = qr.solve(y);
  inverse_ = (X.transpose() * X).inverse();
  analyse(X, y, runs);
}

void ResponseSurface::name_terms() {
  terms_ = {"1"};
  for (const Factor& f : factors_) terms_.push_back(f.name);
  if (model_ == SurfaceModel::kLinear) return;
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    for (std::size_t j = i + 1; j < factors_.size(); ++j) {
      terms_.push_back(factors_[i].name + "*" + factors_[j].name);
    }
  }
  if (model_ == SurfaceModel::kInteractions) return;
  for (const Factor& f : factors_) terms_.push_back(f.name + "^2");
}

Eigen::VectorXd ResponseSurface::row(const std::vector<double>& x) const {
  Eigen::VectorXd r(static_cast<Eigen::Index>(terms_.size()));
  Eigen::Index at = 0;
  r[at++] = 1;
  for (const double v : x) r[at++] = v;
  if (model_ == SurfaceModel::kLinear) return r;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = i + 1; j < x.size(); ++j) r[at++] = x[i] * x[j];
  }
  if (model_ == SurfaceModel::kInteractions) return r;
  for (const double v : x) r[at++] = v * v;
  return r;
}

void ResponseSurface::analyse(const Eigen::MatrixXd& X, const Eigen::VectorXd& y,
                              const Runs& runs) {
  const auto n = static_cast<int>(X.rows()), k = static_cast<int>(X.cols());
  fitted_ = X * coded_;
  residuals_ = y - fitted_;
  const double error = residuals_.squaredNorm();
  const double total = (y.array() - y.mean()).square().sum();
  residual_freedom_ = n - k;
  const double mean_error = residual_freedom_ > 0 ? error / residual_freedom_ : kNone;
  residual_deviation_ = std::sqrt(mean_error);
  r2_ = 1 - error / total;
  adjusted_r2_ = 1 - mean_error / (total / (n - 1));

  double press = 0;
  for (int i = 0; i < n; ++i) {
    const double leverage = X.row(i) * inverse_ * X.row(i).transpose();
    // A run that alone tells a term is foretold by no other.
    press += leverage < 1 - 1e-9 ? std::pow(residuals_[i] / (1 - leverage), 2) : kNone;
  }
  predicted_r2_ = 1 - press / total;
  adequate_precision_ = (fitted_.maxCoeff() - fitted_.minCoeff()) / std::sqrt(k * mean_error / n);

  rows_ = {variance_row("model", total - error, k - 1, mean_error, residual_freedom_)};
  for (int i = 1; i < k; ++i) {
    const double squares = coded_[i] * coded_[i] / inverse_(i, i);
    rows_.push_back(variance_row(terms_[static_cast<std::size_t>(i)], squares, 1, mean_error,
                                 residual_freedom_));
  }
  rows_.push_back({"residual", error, residual_freedom_, mean_error, kNone, kNone});
  std::vector<std::vector<double>> coded;
  for (const auto& natural : runs.factors) {
    coded.emplace_back();
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      coded.back().push_back(factors_[f].coded(natural[f]));
    }
  }
  const VarianceRow pure = pure_error(coded, y);
  if (pure.freedom > 0) {
    rows_.push_back(variance_row("lack of fit", error - pure.sum_of_squares,
                                 residual_freedom_ - pure.freedom, pure.mean_square, pure.freedom));
    rows_.push_back(pure);
  }
  rows_.push_back({"total", total, n - 1, kNone, kNone, kNone});
}

/// x = (value - middle) / half put into each term, and powers of the values collected.
Eigen::VectorXd ResponseSurface::natural() const {
  const std::size_t count = factors_.size();
  std::map<std::vector<int>, double> powers;
  const auto add = [&](std::vector<std::size_t> which, double b) {
    // Product over the listed factors of (v - m) / h.
    for (unsigned pick = 0; pick < (1u << which.size()); ++pick) {
      std::vector<int> power(count, 0);
      double c = b;
      for (std::size_t i = 0; i < which.size(); ++i) {
        const Factor& f = factors_[which[i]];
        const bool variable = (pick >> i) & 1u;
        if (variable) ++power[which[i]];
        c *= (variable ? 1 : -f.middle()) / f.half();
      }
      powers[power] += c;
    }
  };
  Eigen::Index at = 0;
  add({}, coded_[at++]);
  for (std::size_t i = 0; i < count; ++i) add({i}, coded_[at++]);
  if (model_ != SurfaceModel::kLinear) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) add({i, j}, coded_[at++]);
    }
  }
  if (model_ == SurfaceModel::kQuadratic) {
    for (std::size_t i = 0; i < count; ++i) add({i, i}, coded_[at++]);
  }
  Eigen::VectorXd natural(coded_.size());
  at = 0;
  const auto take = [&](std::vector<std::size_t> which) {
    std::vector<int> power(count, 0);
    for (const std::size_t f : which) ++power[f];
    natural[at++] = powers[power];
  };
  take({});
  for (std::size_t i = 0; i < count; ++i) take({i});
  if (model_ != SurfaceModel::kLinear) {
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i + 1; j < count; ++j) take({i, j});
    }
  }
  if (model_ == SurfaceModel::kQuadratic) {
    for (std::size_t i = 0; i < count; ++i) take({i, i});
  }
  return natural;
}

Eigen::VectorXd ResponseSurface::coded_errors() const {
  return residual_deviation_ * inverse_.diagonal().cwiseSqrt();
}

double ResponseSurface::at(const std::vector<double>& coded) const {
  return row(coded).dot(coded_);
}

double ResponseSurface::half95(double leverage) const {
  if (residual_freedom_ < 1) return kNone;
  const boost::math::students_t t(residual_freedom_);
  return boost::math::quantile(t, 0.975) * residual_deviation_ * std::sqrt(leverage);
}

double ResponseSurface::mean_half95(const std::vector<double>& coded) const {
  const Eigen::VectorXd r = row(coded);
  return half95(r.dot(inverse_ * r));
}

double ResponseSurface::run_half95(const std::vector<double>& coded) const {
  const Eigen::VectorXd r = row(coded);
  return half95(1 + r.dot(inverse_ * r));
}

std::vector<double> ResponseSurface::optimum(bool largest) const {
  const std::size_t count = factors_.size();
  const double sign = largest ? 1 : -1;
  std::vector<double> best;
  double most = -std::numeric_limits<double>::infinity();
  std::size_t starts = 1;
  for (std::size_t f = 0; f < count; ++f) starts *= 3;
  for (std::size_t s = 0; s < starts; ++s) {
    std::vector<double> x;
    for (std::size_t f = 0, rest = s; f < count; ++f, rest /= 3) {
      x.push_back(static_cast<double>(rest % 3) - 1);
    }
    double value = sign * at(x);
    for (int round = 0; round < 1000; ++round) {
      const double before = value;
      for (std::size_t f = 0; f < count; ++f) {
        // Along one factor it is a parabola: its ends and its vertex.
        std::vector<double> low = x, middle = x, high = x;
        low[f] = -1, middle[f] = 0, high[f] = 1;
        const double a = sign * at(low), b = sign * at(middle), c = sign * at(high);
        const double bend = a - 2 * b + c;
        std::vector<double> candidates = {-1, 1};
        if (bend < 0) candidates.push_back(std::clamp(0.5 * (a - c) / bend, -1.0, 1.0));
        for (const double candidate : candidates) {
          std::vector<double> there = x;
          there[f] = candidate;
          const double v = sign * at(there);
          if (v > value) value = v, x = there;
        }
      }
      if (!(value > before + 1e-13 * (1 + std::abs(value)))) break;
    }
    if (value > most) most = value, best = x;
  }
  return best;
}

}  // namespace hoof::tools
