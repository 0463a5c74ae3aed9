#include "firmware/control/seconds.h"

#include <catch2/catch.hpp>
#include <random>

using hoof::firmware::control::seconds;

TEST_CASE("nanoseconds become seconds as a conversion of all 64 bits would round them") {
  const auto agrees = [](std::int64_t time_ns) {
    return seconds(time_ns) == static_cast<float>(time_ns) * 1e-9f;
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
  CHECK(seconds(2'500'000'000) == 2.5f);
}
