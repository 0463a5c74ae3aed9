// How a goal ran between its samples: smooth paths as they were, steps as steps.
#include "tools/diagnose/goal_slopes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace hoof::tools;

namespace {

/// Hermite's cubic between samples i and i+1, at the share x.
double between(const std::vector<double>& t, const std::vector<double>& y,
               const std::vector<double>& slope, std::size_t i, double x) {
  const double h = t[i + 1] - t[i];
  return (1 + 2 * x) * (1 - x) * (1 - x) * y[i] + x * (1 - x) * (1 - x) * h * slope[i] +
         x * x * (3 - 2 * x) * y[i + 1] - x * x * (1 - x) * h * slope[i + 1];
}

Recording path(const std::vector<double>& times, double (*y)(double), double (*v)(double)) {
  Recording r;
  r.time_s = times;
  for (const double t : times) {
    r.channels["position_goal"].push_back(y(t));
    if (v) r.channels["velocity_goal"].push_back(v(t));
  }
  return r;
}

std::vector<double> jittered(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> step(0.003, 0.007);
  std::vector<double> t{0};
  while (t.back() < 1.2) t.push_back(t.back() + step(random));
  return t;
}

/// The largest error in the middle of two samples.
double worst(const Recording& r, const std::vector<double>& slopes, double (*y)(double)) {
  const auto& t = r.time_s;
  double most = 0;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double middle = 0.5 * (t[i] + t[i + 1]);
    most = std::max(
        most, std::abs(between(t, r.channels.at("position_goal"), slopes, i, 0.5) - y(middle)));
  }
  return most;
}

double rising(double t) {
  return std::exp(3 * t);
}
double rise(double t) {
  return 3 * std::exp(3 * t);
}
double sine(double t) {
  return std::sin(9 * t);
}

}  // namespace

TEST_CASE("goal slopes: a smooth path is closer than by straight lines") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    CAPTURE(seed);
    const Recording alone = path(jittered(seed), rising, nullptr);
    const Recording told = path(alone.time_s, rising, rise);
    // y'' h^2 / 8 with y'' = 9 exp(3.6), h = 7 ms
    const double straight = 9 * std::exp(3.6) * 0.007 * 0.007 / 8;
    CHECK(worst(alone, goal_slopes(alone).position, rising) < 0.3 * straight);
    // y'''' h^4 / 384: less than a thousandth of that
    CHECK(worst(told, goal_slopes(told).position, rising) < 1e-3 * straight);
    const Recording swing = path(alone.time_s, sine, nullptr);
    CHECK(worst(swing, goal_slopes(swing).position, sine) < 0.3 * 81 * 0.007 * 0.007 / 8);
  }
}

TEST_CASE("goal slopes: a step stays a step, and what rises stays between its samples") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    CAPTURE(trial);
    Recording r;
    r.time_s = jittered(100 + static_cast<std::uint64_t>(trial));
    double goal = 0;
    const double sign = trial % 3 == 0 ? -1 : 1;
    for (std::size_t i = 0; i < r.time_s.size(); ++i) {
      if (random() % 4 == 0) goal += sign * std::abs(normal(random));  // held, then moved
      r.channels["position_goal"].push_back(goal);
      r.channels["velocity_goal"].push_back(trial % 2 == 0 ? 0 : 50 * normal(random));
    }
    const GoalSlopes slopes = goal_slopes(r);
    const auto& y = r.channels["position_goal"];
    for (std::size_t i = 0; i + 1 < y.size(); ++i) {
      for (const double x : {0.1, 0.35, 0.5, 0.8}) {
        const double at = between(r.time_s, y, slopes.position, i, x);
        CHECK(at >= std::min(y[i], y[i + 1]) - 1e-12);
        CHECK(at <= std::max(y[i], y[i + 1]) + 1e-12);
      }
    }
  }
}
