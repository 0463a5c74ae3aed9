#include "firmware/control/math.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace control = hoof::firmware::control;

TEST_CASE("sin and cos keep their error bound between -100 and 100 rad") {
  double worst = 0.0;
  for (int i = -1000000; i <= 1000000; ++i) {
    const float x = static_cast<float>(i) * 1e-4f;
    const control::SinCos result = control::sin_cos(x);
    worst = std::max(worst, std::abs(double{result.sin} - std::sin(double{x})));
    worst = std::max(worst, std::abs(double{result.cos} - std::cos(double{x})));
  }
  CAPTURE(worst);
  CHECK(worst < 1.5e-7);
  CHECK(worst > 1e-9);  // not compared with itself
}

TEST_CASE("sin and cos at the quarters") {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const control::SinCos result = control::sin_cos(static_cast<float>(quarter) * control::kHalfPi);
    const int sines[] = {0, 1, 0, -1};
    CHECK(result.sin == Approx(sines[(quarter % 4 + 4) % 4]).margin(1e-6));  // of the argument
    CHECK(result.cos == Approx(sines[((quarter + 1) % 4 + 4) % 4]).margin(1e-6));
  }
}

TEST_CASE("atan2 keeps its error bound all around and at all scales") {
  double worst = 0.0;
  for (const double radius : {1e-12, 1.0, 1e12}) {
    for (int i = -200000; i <= 200000; ++i) {
      const double angle = i * (3.14159 / 200000);
      const float y = static_cast<float>(radius * std::sin(angle));
      const float x = static_cast<float>(radius * std::cos(angle));
      const double exact = std::atan2(double{y}, double{x});
      worst = std::max(worst, std::abs(control::atan2(y, x) - exact));
    }
  }
  CAPTURE(worst);
  CHECK(worst < 4e-7);
  CHECK(worst > 1e-9);
}

TEST_CASE("atan2 on the axes and at the origin") {
  CHECK(control::atan2(0.0f, 1.0f) == 0.0f);
  CHECK(control::atan2(0.0f, -1.0f) == control::kPi);
  CHECK(control::atan2(1.0f, 0.0f) == control::kHalfPi);
  CHECK(control::atan2(-1.0f, 0.0f) == -control::kHalfPi);
  CHECK(control::atan2(0.0f, 0.0f) == 0.0f);
}

TEST_CASE("acos keeps its error bound and takes arguments a hair beyond one") {
  double worst = 0.0;
  for (int i = -1000000; i <= 1000000; ++i) {
    const float x = static_cast<float>(i) * 1e-6f;
    worst = std::max(worst, std::abs(control::acos(x) - std::acos(double{x})));
  }
  CAPTURE(worst);
  CHECK(worst < 4e-7);
  CHECK(control::acos(1.0000001f) == 0.0f);
  CHECK(control::acos(-1.0000001f) == control::kPi);
}

TEST_CASE("Finite means finite") {
  CHECK(control::is_finite(0.0f));
  CHECK(control::is_finite(std::numeric_limits<float>::max()));
  CHECK_FALSE(control::is_finite(std::nanf("")));
  CHECK_FALSE(control::is_finite(std::numeric_limits<float>::infinity()));
  CHECK_FALSE(control::is_finite(-std::numeric_limits<float>::infinity()));
}

TEST_CASE("nanoseconds become seconds as a conversion of all 64 bits would round them") {
  const auto agrees = [](std::int64_t time_ns) {
    return control::seconds(time_ns) == static_cast<float>(time_ns) * 1e-9f;
  };
  for (const std::int64_t edge : {std::int64_t{0}, std::int64_t{1} << 31, std::int64_t{1} << 32}) {
    for (std::int64_t off = -300; off <= 300; ++off) {
      CAPTURE(edge, off);
      REQUIRE(agrees(edge + off));
      REQUIRE(agrees(-edge + off));
    }
  }
  std::mt19937_64 random(1);
  for (int i = 0; i < 100'000; ++i) {
    const std::int64_t time_ns = static_cast<std::int64_t>(random()) >> (random() % 64);
    CAPTURE(time_ns);
    REQUIRE(agrees(time_ns));
  }
  CHECK(control::seconds(2'500'000'000) == 2.5f);
}
