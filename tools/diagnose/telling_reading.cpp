#include "tools/diagnose/telling_reading.h"

#include <cmath>
#include <vector>

namespace hoof::tools {
namespace {

constexpr std::size_t kWindows = 40;
/// A mean is read more surely than a sample, and more easily than a change.
constexpr double kLessEasy = 0.8;

Eigen::Index length(const SampleSpan& span) {
  return static_cast<Eigen::Index>(span.last - span.first + 1);
}

double mean_y(const WhitePrediction& p, const SampleSpan& span) {
  return p.y.segment(static_cast<Eigen::Index>(span.first), length(span)).mean();
}

Eigen::RowVectorXd mean_M(const WhitePrediction& p, const SampleSpan& span) {
  return p.M.middleRows(static_cast<Eigen::Index>(span.first), length(span)).colwise().mean();
}

/// What a window says of both hypotheses.
struct Window {
  SampleSpan span;
  double difference = 0;
  Eigen::RowVectorXd directions;  // of both
  double noise_squared = 0;
};

Window window_of(const WhitePrediction& a, const WhitePrediction& b, SampleSpan span) {
  Window w{span, mean_y(a, span) - mean_y(b, span), Eigen::RowVectorXd(a.M.cols() + b.M.cols()),
           1.0 / static_cast<double>(length(span))};
  w.directions << mean_M(a, span), mean_M(b, span);
  return w;
}

double sigmas(const Window& w) {
  return std::abs(w.difference) / std::sqrt(w.noise_squared + w.directions.squaredNorm());
}

double sigmas_of_change(const Window& late, const Window& early) {
  const double squared =
      late.noise_squared + early.noise_squared + (late.directions - early.directions).squaredNorm();
  return std::abs(late.difference - early.difference) / std::sqrt(squared);
}

}  // namespace

Reading most_telling(const WhitePrediction& a, const WhitePrediction& b) {
  const auto count = static_cast<std::size_t>(a.y.size());
  Reading best;
  double ease = 0;
  const auto offer = [&](const Reading& reading, double easy) {
    if (easy * reading.sigmas > ease) best = reading, ease = easy * reading.sigmas;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const SampleSpan span{i, i};
    offer({span, {}, false, sigmas(window_of(a, b, span))}, kLessEasy);
  }
  if (count < 2 * kWindows) return best;
  std::vector<Window> windows;
  for (std::size_t i = 0; i < kWindows; ++i) {
    windows.push_back(window_of(a, b, {i * count / kWindows, (i + 1) * count / kWindows - 1}));
  }
  for (std::size_t i = 0; i < kWindows; ++i) {
    offer({windows[i].span, {}, false, sigmas(windows[i])}, 1);
    for (std::size_t j = 0; j < i; ++j) {
      const double change = sigmas_of_change(windows[i], windows[j]);
      offer({windows[i].span, windows[j].span, true, change}, kLessEasy);
    }
  }
  return best;
}

std::pair<double, double> read(const Reading& reading, const WhitePrediction& p) {
  double value = mean_y(p, reading.late);
  Eigen::RowVectorXd directions = mean_M(p, reading.late);
  double noise_squared = 1.0 / static_cast<double>(length(reading.late));
  if (reading.change) {
    value -= mean_y(p, reading.early);
    directions -= mean_M(p, reading.early);
    noise_squared += 1.0 / static_cast<double>(length(reading.early));
  }
  return {value, std::sqrt(noise_squared + directions.squaredNorm())};
}

}  // namespace hoof::tools
