// How a goal ran between its samples: smooth paths as they were, corners as corners, steps as
// steps.
#include "tools/diagnose/goal_bends.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof;
using namespace hoof::tools;

namespace {

double between(const std::vector<double>& t, const std::vector<double>& y, const Bends& bend,
               std::size_t i, double x) {
  const double straight = y[i] + x * (y[i + 1] - y[i]);
  return straight + (t[i + 1] - t[i]) * x * (1 - x) * ((1 - x) * bend[i].start - x * bend[i].end);
}

std::vector<double> jittered(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> step(0.003, 0.007);
  std::vector<double> t{0};
  while (t.back() < 1.2) t.push_back(t.back() + step(random));
  return t;
}

/// The largest error in the middle of two samples, the spans at both ends left out.
double worst(const std::vector<double>& t, double (*path)(double)) {
  std::vector<double> y;
  for (const double v : t) y.push_back(path(v));
  const Bends bend = bends(t, y);
  double most = 0;
  for (std::size_t i = 1; i + 2 < t.size(); ++i) {
    most = std::max(most, std::abs(between(t, y, bend, i, 0.5) - path(0.5 * (t[i] + t[i + 1]))));
  }
  return most;
}

double rising(double t) {
  return std::exp(3 * t);
}
double parabola(double t) {
  return 1 - 2 * t + 5 * t * t;
}
/// From rest at 0.4 s with a constant jerk.
double jerk(double t) {
  return t < 0.4 ? 0 : std::pow(t - 0.4, 3);
}

}  // namespace

TEST_CASE("goal bends: a smooth path is closer than by straight lines") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    const auto t = jittered(seed);
    CHECK(worst(t, parabola) < 1e-12);
    // Straight: y'' h^2 / 8 with y'' = 9 exp(3.6), h = 7 ms. What is left is of the next order.
    CHECK(worst(t, rising) < 0.05 * 9 * std::exp(3.6) * 0.007 * 0.007 / 8);
    // Straight: 6 (1.2 - 0.4) h^2 / 8.
    CHECK(worst(t, jerk) < 0.05 * 6 * 0.8 * 0.007 * 0.007 / 8);
  }
}

TEST_CASE("goal bends: corners and steps of paths in straight pieces are exact") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    CAPTURE(trial);
    const auto t = jittered(100 + static_cast<std::uint64_t>(trial));
    // Corners and steps at samples, three or more of them apart, each a turn or a jump.
    std::vector<double> y;
    double slope = 0, value = 0;
    std::size_t next = 4;
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (i > 0) value += slope * (t[i] - t[i - 1]);
      if (i == next) {
        if (random() % 2 == 0)
          slope = 10 * normal(random);
        else
          value += normal(random);
        next += 4 + random() % 20;
      }
      y.push_back(value);
    }
    const Bends bend = bends(t, y);
    for (std::size_t i = 0; i + 1 < y.size(); ++i) {
      // Rounding of slopes, divided by a step of 3 ms.
      CHECK(std::abs(bend[i].start) * (t[i + 1] - t[i]) < 1e-9);
      CHECK(bend[i].start == -bend[i].end);
    }
  }
}

TEST_CASE("goal bends: a velocity goal tells the slopes where it belongs to the path") {
  Recording r;
  r.time_s = jittered(9);
  for (const double t : r.time_s) {
    r.channels["position_goal"].push_back(std::exp(3 * t));
    r.channels["velocity_goal"].push_back(3 * std::exp(3 * t));
  }
  const GoalBends told = goal_bends(r);
  const auto& t = r.time_s;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double middle = 0.5 * (t[i] + t[i + 1]);
    // y h^4 / 384 with y = 81 exp(3.6): 2e-8
    CHECK(between(t, r.channels["position_goal"], told.position, i, 0.5) ==
          Approx(std::exp(3 * middle)).margin(3e-8));
  }
  // One that is zero throughout, as of a drive that has none, tells nothing.
  r.channels["velocity_goal"].assign(t.size(), 0);
  const Bends alone = bends(t, r.channels["position_goal"]), beside = goal_bends(r).position;
  for (std::size_t i = 0; i < alone.size(); ++i) CHECK(alone[i].start == beside[i].start);
  // Of a ramp that begins at a sample it does not round the corner.
  for (std::size_t i = 0; i < t.size(); ++i) {
    r.channels["position_goal"][i] = 4 * std::max(t[i] - t[20], 0.0);
    r.channels["velocity_goal"][i] = i >= 20 ? 4 : 0;
  }
  for (const sim::SlopeOffset& b : goal_bends(r).position) CHECK(std::abs(b.start) < 1e-9);
}

TEST_CASE("goal bends: too few samples and repeated times are straight") {
  CHECK(bends(std::vector<double>{}, std::vector<double>{}).empty());
  for (const auto& b : bends(std::vector<double>{0, 1}, std::vector<double>{0, 5})) {
    CHECK((b.start == 0 && b.end == 0));
  }
  const std::vector<double> repeated = {0, 1, 1, 2}, values = {0, 5, 6, 2};
  for (const auto& b : bends(repeated, values)) CHECK(std::isfinite(b.start));
}
