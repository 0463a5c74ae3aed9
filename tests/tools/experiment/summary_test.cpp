#include "tools/experiment/summary.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/multibody/shipped.h"
#include "tools/experiment/bench.h"
#include "tools/experiment/foot_plan.h"

using namespace hoof;
using tools::find_peaks;
using tools::foot_plan_m;
using tools::ForceSample;
using tools::TractionPeaks;

namespace {

constexpr int kTicks = 400;
constexpr double kTick_s = 1e-3;

template <typename Fx, typename Fz>
std::vector<ForceSample> forces(Fx fx, Fz fz) {
  std::vector<ForceSample> samples;
  for (int i = 0; i < kTicks; ++i) samples.push_back({i * kTick_s, fx(i), fz(i)});
  return samples;
}

double pulse(int tick, int from, int to, double height) {
  return tick >= from && tick < to ? height : 0;
}

}  // namespace

TEST_CASE("peaks of pulses wider than the window are their heights") {
  const TractionPeaks p = find_peaks(forces([](int i) { return pulse(i, 100, 150, 30.0); },
                                            [](int i) { return pulse(i, 50, 200, 60.0); }));
  CHECK(p.fx_peak_N == Approx(30));
  CHECK(p.fz_at_fx_peak_N == Approx(60));
  CHECK(p.fz_peak_N == Approx(60));
  CHECK(p.traction_coefficient() == Approx(0.5));
  CHECK(p.fx_peak_time_s == Approx(0.105));  // first window that lies inside, by its middle
}

TEST_CASE("a spike of one tick counts for an eleventh") {
  const TractionPeaks p = find_peaks(forces([](int i) { return pulse(i, 100, 101, 110.0); },
                                            [](int i) { return pulse(i, 300, 301, 220.0); }));
  CHECK(p.fx_peak_N == Approx(10));
  CHECK(p.fz_peak_N == Approx(20));
}

TEST_CASE("the vertical force is taken where the propulsive one peaks, not where it peaks itself") {
  const TractionPeaks p =
      find_peaks(forces([](int i) { return 40 * std::exp(-std::pow((i - 200) / 40.0, 2)); },
                        [](int i) { return 100 - 0.2 * i; }));
  CHECK(p.fx_peak_time_s == Approx(0.2));
  CHECK(p.fz_at_fx_peak_N == Approx(60));
  CHECK(p.fz_peak_N == Approx(99));  // mean over the first window, ticks 0 to 10
  CHECK(p.fx_peak_N < 40);
  CHECK(p.fx_peak_N > 39.5);  // the mean over +-5 ticks of a bell of 40 ticks: 0.6 % lower
}

TEST_CASE("a force that only brakes has no peak") {
  const TractionPeaks p = find_peaks(forces([](int i) { return -pulse(i, 100, 150, 30.0); },
                                            [](int i) { return pulse(i, 100, 150, 60.0); }));
  CHECK(p.fx_peak_N == 0);
  CHECK(std::isnan(p.traction_coefficient()));
  CHECK(p.fz_peak_N == Approx(60));
}

TEST_CASE("nothing touched, or too short: zeros, not a division by zero") {
  CHECK(std::isnan(find_peaks({}).traction_coefficient()));
  CHECK(find_peaks({{0, 5, 5}}).fx_peak_N == 0);
}

TEST_CASE("the footprint of a foot without toes is its sole, of an STL its box") {
  const Eigen::Vector2d size = foot_plan_m(sim::shipped_foot("traditional"), 0).sizes();
  // Without the rounding of the edges, which starts above the sole.
  CHECK(size.x() == Approx(0.175).margin(1e-9));
  CHECK(size.y() == Approx(0.040).margin(1e-9));
}

TEST_CASE("the footprint of opened toes follows their hinges") {
  // sim/config/feet/bionic-plain.toml: hinge 33 mm off the middle, toe 145 mm long, 25 mm wide at
  // the hinge, 20 mm at the tip.
  const sim::Foot foot = sim::shipped_foot("bionic-plain");
  const double hinge_m = foot.hinges.left_F_m.y();
  CHECK(hinge_m == Approx(0.033));
  double last_m = 0;
  for (const double toe_deg : {0.0, 20.0, 40.0}) {
    CAPTURE(toe_deg);
    const double toe_rad = toe_deg * M_PI / 180;
    double farthest_m = 0;
    for (const Eigen::Vector3d& v : foot.left_toe.vertices_m) {
      const double y_m = std::sin(toe_rad) * v.x() + std::cos(toe_rad) * v.y();
      farthest_m = std::max(farthest_m, hinge_m + y_m);
    }
    const Eigen::Vector2d size = foot_plan_m(foot, toe_rad).sizes();
    CHECK(size.y() == Approx(2 * farthest_m));
    CHECK(size.y() > last_m);
    CHECK(size.x() >= 0.175 - 1e-9);
    last_m = size.y();
  }
  // By hand: 2 (33 + 12.5) mm closed; at 40 degrees the tip's corner leads.
  CHECK(foot_plan_m(foot, 0).sizes().y() == Approx(0.091).margin(1e-9));
  const double wide_m = foot_plan_m(foot, 40 * M_PI / 180).sizes().y();
  CHECK(wide_m > 2 * (0.033 + 0.120 * std::sin(40 * M_PI / 180)));
  CHECK(wide_m < 2 * (0.033 + 0.145 * std::sin(40 * M_PI / 180) + 0.0125));
}
