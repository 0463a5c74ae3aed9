#include "tools/study/statistics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

using namespace hoof::tools;

TEST_CASE("mean, scatter and confidence of a few values") {
  // 1, 2, 3, 4, 5: variance 2.5, t(4) = 2.776 (any table of Student's t).
  const Sample s = sample_of({1, 2, 3, 4, 5});
  CHECK(s.n == 5);
  CHECK(s.mean == Approx(3));
  CHECK(s.deviation == Approx(std::sqrt(2.5)));
  CHECK(s.standard_error == Approx(std::sqrt(0.5)));
  CHECK(s.confidence == Approx(2.776 * std::sqrt(0.5)));
  CHECK(s.above_one == 4);  // 1 itself is not above
}

TEST_CASE("a sample below one has the same scatter and no value above one") {
  const Sample s = sample_of({-1, -2, -3, -4, -5});
  CHECK(s.mean == Approx(-3));
  CHECK(s.deviation == Approx(std::sqrt(2.5)));
  CHECK(s.above_one == 0);
}

TEST_CASE("rank correlation: order alone counts, ties share a rank") {
  CHECK(rank_correlation({1, 2, 3, 4}, {10, 200, 201, 1e6}) == Approx(1));
  CHECK(rank_correlation({1, 2, 3, 4}, {4, 1, 0, -7}) == Approx(-1));
  // 1 - 6 sum d^2 / (n (n^2 - 1)) without ties: d = 1, -1, 0, 1, -1 of five.
  CHECK(rank_correlation({1, 2, 3, 4, 5}, {2, 1, 3, 5, 4}) == Approx(1 - 6.0 * 4 / (5 * 24)));
  // Ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4: 4.5 / sqrt(4.5 * 5).
  CHECK(rank_correlation({0, 7, 7, 9}, {1, 2, 3, 4}) == Approx(4.5 / std::sqrt(22.5)));
  CHECK(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3})));
  CHECK(std::isnan(rank_correlation({}, {})));
  CHECK_THROWS_AS(rank_correlation({1}, {1, 2}), std::invalid_argument);
}

TEST_CASE("kendall: pairs in order less pairs out of it, over those that are not equal") {
  CHECK(kendall_correlation({1, 2, 3, 4}, {10, 200, 201, 1e6}) == Approx(1));
  CHECK(kendall_correlation({1, 2, 3, 4}, {4, 1, 0, -7}) == Approx(-1));
  // Two of ten pairs the other way round.
  CHECK(kendall_correlation({1, 2, 3, 4, 5}, {2, 1, 3, 5, 4}) == Approx(0.6));
  // One tie of six pairs in one list: 5 / sqrt(5 * 6).
  CHECK(kendall_correlation({0, 7, 7, 9}, {1, 2, 3, 4}) == Approx(5 / std::sqrt(30.0)));
  CHECK(std::isnan(kendall_correlation({1, 1, 1}, {1, 2, 3})));
  CHECK_THROWS_AS(kendall_correlation({1}, {1, 2}), std::invalid_argument);
}

TEST_CASE("one value has no scatter that could be known; runs that failed do not count") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Sample one = sample_of({nan, 1.5, nan});
  CHECK(one.n == 1);
  CHECK(one.mean == 1.5);
  CHECK(std::isnan(one.deviation));
  CHECK(std::isnan(one.confidence));
  const Sample none = sample_of({nan});
  CHECK(none.n == 0);
  CHECK(std::isnan(none.mean));
}

TEST_CASE("Student's t falls with the degrees of freedom and never below that of 10") {
  CHECK(student_t_975(1) == 12.706);
  CHECK(student_t_975(4) == 2.776);
  CHECK(student_t_975(10) == 2.228);
  CHECK(student_t_975(1000) == 2.228);  // true value 1.962: on the safe side
  CHECK(std::isnan(student_t_975(0)));
  for (std::size_t n = 2; n < 12; ++n) CHECK(student_t_975(n) <= student_t_975(n - 1));
}
