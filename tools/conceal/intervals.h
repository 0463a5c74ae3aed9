#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hoof::tools::conceal {

/// How strongly an effect is at work at each sample of a recording.
struct StrengthSeries {
  std::string recording;
  bool holdout = false;
  std::vector<double> times_s, strength;
};

struct TimeInterval {
  std::string recording;
  double start_s = 0, end_s = 0;
};

/// Where the strength, smoothed over 0.1 s, lies above its median over all recordings: at most half
/// of the time. Gaps under 0.1 s are closed. Nothing where the strength is nearly the same always.
std::vector<TimeInterval> strong_intervals(std::vector<StrengthSeries> series);

nlohmann::ordered_json to_json(const std::vector<TimeInterval>& intervals);

}  // namespace hoof::tools::conceal
