#include "tools/compare/comparison.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <sstream>

#include "tools/compare/compare_text.h"
#include "tools/run/errors.h"

using namespace hoof::tools;

namespace {

/// f over 0 to 2 s in milliseconds.
template <typename F>
SignalSeries series(const std::string& name, F f, double start_s = 0, double step_s = 1e-3) {
  SignalSeries s;
  s.name = name;
  for (int i = 0; i <= int(std::lround(2.0 / step_s)); ++i) {
    s.time_s.push_back(start_s + i * step_s);
    s.values.push_back(f(i * step_s));
  }
  return s;
}

double wave(double t) {
  return 10 * std::sin(3 * t);
}

/// One hump, so that there is one best alignment.
double hump(double t) {
  return std::exp(-20 * (t - 1) * (t - 1));
}

}  // namespace

TEST_CASE("tolerance is the larger of absolute and relative times the baseline, in both signs") {
  const Tolerance t{0.5, 0.1};
  CHECK(t.at(1) == 0.5);
  CHECK(t.at(20) == Approx(2));
  CHECK(t.at(-20) == Approx(2));
  CHECK(default_tolerance({"x_m_s", false, {}, {}, {}}).absolute == 5e-3);  // not that of _s
  CHECK(default_tolerance({"x_rad", false, {}, {}, {}}).absolute == 2e-3);
  CHECK(default_tolerance({"count_m", true, {}, {}, {}}).absolute == 0);
}

TEST_CASE("a difference just inside passes, just outside is found at its moment, either way") {
  const auto a = series("fz_N", wave);
  for (const double sign : {1.0, -1.0}) {
    const auto off = [&](double by) {
      return series("fz_N", [&](double t) { return wave(t) + (t >= 1.2345 ? sign * by : 0); });
    };
    CompareOptions options;
    options.tolerances = {parse_tolerance_rule("fz_N=0.5")};
    const Comparison inside = compare({a}, {off(0.499)}, options);
    CHECK(inside.within());
    CHECK(inside.signals[0].verdict == SignalVerdict::kWithin);
    CHECK(inside.signals[0].largest == Approx(0.499));
    const Comparison outside = compare({a}, {off(0.501)}, options);
    CHECK_FALSE(outside.within());
    REQUIRE(outside.signals[0].first_outside_s);
    CHECK(*outside.signals[0].first_outside_s == Approx(1.235));
    // 766 of 2001 moments are off by 0.501.
    CHECK(outside.signals[0].outside == 766);
    CHECK(outside.signals[0].rms == Approx(0.501 * std::sqrt(766.0 / 2001)));
  }
}

TEST_CASE("equal ones are the same; other sampling of one curve is within") {
  const auto a = series("x_m", wave);
  CHECK(compare({a}, {a}, {}).signals[0].verdict == SignalVerdict::kSame);
  // Between samples 7 ms apart a line is off by at most f'' h^2 / 8 = 90 * 49e-6 / 8 = 5.5e-4.
  CompareOptions options;
  options.tolerances = {parse_tolerance_rule("x_m=5.6e-4")};
  const Comparison c = compare({a}, {series("x_m", wave, 0, 7e-3)}, options);
  CHECK(c.within());
  CHECK(c.signals[0].largest > 1e-4);
}

TEST_CASE("a shift is found by the signal told, to a sample") {
  const auto seed = std::random_device()();
  CAPTURE(seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 5; ++round) {
    const double start_s = std::uniform_int_distribution(-300, 300)(random) * 1e-3;
    CAPTURE(start_s);
    const auto a = series("x_m", hump), b = series("x_m", hump, start_s);
    CompareOptions options;
    options.align_signal = "x_m";
    const Comparison c = compare({a}, {b}, options);
    CHECK(c.shift_s == Approx(-start_s).margin(1e-9));
    CHECK(c.within());
    if (std::abs(start_s) > 0.01) CHECK_FALSE(compare({a}, {b}, {}).within());
  }
  CompareOptions options;
  options.align_signal = "y_m";
  CHECK_THROWS_WITH(compare({series("x_m", hump)}, {series("x_m", hump)}, options),
                    Catch::Contains("--align y_m: not a signal of A"));
}

TEST_CASE("whole numbers and texts hold their value and allow nothing") {
  SignalSeries a{"phase_name", true, {0, 1, 2, 3}, {0, 0, 1, 1}, {"lowered", "loaded"}};
  SignalSeries b{"phase_name", true, {0, 1, 2, 3}, {0, 0, 0, 1}, {"lowered", "loaded"}};
  const Comparison c = compare({a}, {b}, {});
  CHECK(c.signals[0].verdict == SignalVerdict::kOut);
  CHECK(*c.signals[0].first_outside_s == 2);
  // The same texts under other numbers are the same.
  SignalSeries renumbered{"phase_name", true, {0, 1, 2, 3}, {1, 1, 0, 0}, {"loaded", "lowered"}};
  CHECK(compare({a}, {renumbered}, {}).within());
}

TEST_CASE("missing signals, not-a-number and another length are differences") {
  const auto a = series("x_m", wave), other = series("y_m", wave);
  const Comparison missing = compare({a, other}, {a}, {});
  CHECK_FALSE(missing.within());
  CHECK(missing.signals[1].verdict == SignalVerdict::kOnlyA);
  CHECK(compare({a}, {a, other}, {}).signals[1].verdict == SignalVerdict::kOnlyB);

  auto broken = a;
  broken.values[500] = std::nan("");
  CHECK(*compare({a}, {broken}, {}).signals[0].first_outside_s == Approx(0.5));
  CHECK(*compare({broken}, {a}, {}).signals[0].first_outside_s == Approx(0.5));
  CHECK(compare({broken}, {broken}, {}).within());

  auto shorter = a;
  shorter.time_s.resize(1900), shorter.values.resize(1900);
  const Comparison c = compare({a}, {shorter}, {});
  CHECK(c.length_differs);
  CHECK(c.signals[0].verdict == SignalVerdict::kSame);
  CHECK_FALSE(c.within());
}

TEST_CASE("rules: the last that fits counts; wrong ones say what is wrong") {
  const auto a = series("fz_N", wave);
  const std::vector<ToleranceRule> rules = {parse_tolerance_rule("fz_N=1,0.5"),
                                            parse_tolerance_rule("f*_N=2")};
  CHECK(tolerance_of(a, rules).absolute == 2);
  CHECK(tolerance_of(a, rules).relative == 0);
  for (const char* text : {"fz_N", "=1", "fz_N=", "fz_N=-1", "fz_N=1,x", "fz_N=nan"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_tolerance_rule(text), UserError);
  }
}

TEST_CASE("the table names verdict, difference in shown units and the first divergence") {
  const auto a = series("depth_m", [](double) { return 0.01; });
  const auto b = series("depth_m", [](double t) { return t < 1 ? 0.01 : 0.0125; });
  std::ostringstream out;
  print_comparison(compare({a}, {b}, {}), {"runs/a", "runs/b"}, out);
  CAPTURE(out.str());
  CHECK_THAT(out.str(), Catch::Contains("OUT") && Catch::Contains("2.5 mm") &&
                            Catch::Contains("0.1 mm or 1 %") && Catch::Contains("1.0000"));
}
