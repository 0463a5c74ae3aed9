#include "firmware/safety/overrun.h"

#include <catch2/catch.hpp>

using namespace hoof::firmware;
using safety::OverrunWatch;

namespace {
constexpr std::int64_t kLimit_ns = 1'000'000;
}

TEST_CASE("A tick of a millisecond is none too long, of a nanosecond more it is") {
  OverrunWatch watch;
  for (int i = 0; i < 10; ++i) CHECK(watch.note(i * kLimit_ns, (i + 1) * kLimit_ns) == 0);
  CHECK(watch.overruns() == 0);
  CHECK(watch.note(5, 5 + kLimit_ns + 1) == 0);
  CHECK(watch.overruns() == 1);
}

TEST_CASE("The third overrun in a row is a fault, and so is each that follows; others are not") {
  OverrunWatch watch;
  for (int round = 0; round < 3; ++round) {
    CHECK(watch.note(0, 2 * kLimit_ns) == 0);
    CHECK(watch.note(0, 2 * kLimit_ns) == 0);
    CHECK(watch.note(0, kLimit_ns) == 0);
  }
  CHECK(watch.overruns() == 6);
  CHECK(watch.note(0, 2 * kLimit_ns) == 0);
  CHECK(watch.note(0, 2 * kLimit_ns) == 0);
  for (int i = 0; i < 600; ++i) CHECK(watch.note(0, 2 * kLimit_ns) == control::fault::kOverrun);
  CHECK(watch.overruns() == 608);
  CHECK(watch.note(0, kLimit_ns) == 0);
  CHECK(watch.note(0, 2 * kLimit_ns) == 0);
}
