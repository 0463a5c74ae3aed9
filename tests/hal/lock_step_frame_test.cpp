#include "hal/lock_step_frame.h"

#include <catch2/catch.hpp>
#include <random>

#include "hal/can_frame_check.h"

using namespace hoof::hal;
using lock_step::Done;
using lock_step::Go;

TEST_CASE("what a simulator says comes back as it was, over the whole range") {
  const auto seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 1'000; ++i) {
    Go go;
    go.time_ns = std::int64_t(random() >> (16 + random() % 48));
    go.answer = random() % 2 != 0;
    for (int bus = 0; bus < 2; ++bus) {
      go.bus_off[bus] = random() % 2 != 0;
      go.free[bus] = int(random() % (lock_step::kMostFree + 1));
    }
    const CanFrame frame = encode(go);
    REQUIRE(can_exist(frame));
    const auto back = lock_step::decode_go(frame);
    REQUIRE(back);
    CHECK(back->time_ns == go.time_ns);
    CHECK(back->answer == go.answer);
    for (int bus = 0; bus < 2; ++bus) {
      CHECK(back->bus_off[bus] == go.bus_off[bus]);
      CHECK(back->free[bus] == go.free[bus]);
    }
    const Done done{std::uint32_t(random()), std::uint32_t(random())};
    const auto done_back = lock_step::decode_done(encode(done));
    REQUIRE(done_back);
    CHECK(done_back->time_us == done.time_us);
    CHECK(done_back->due_in_us == done.due_in_us);
  }
}

TEST_CASE("room for more frames than can be told is told as the most") {
  Go go;
  go.free[0] = 16;
  go.free[1] = -1;
  CHECK(lock_step::decode_go(encode(go))->free[0] == lock_step::kMostFree);
  CHECK(lock_step::decode_go(encode(go))->free[1] == 0);
}

TEST_CASE("only well-formed frames are words of a simulator") {
  const CanFrame good = encode(Go{});
  CHECK(lock_step::decode_go(good));
  CHECK_FALSE(lock_step::decode_done(good));
  for (int what = 0; what < 5; ++what) {
    CanFrame bad = good;
    if (what == 0) bad.extended = false;
    if (what == 1) bad.remote = true;
    if (what == 2) bad.fd = true;
    if (what == 3) bad.length = 7;
    if (what == 4) bad.error = true;
    CAPTURE(what);
    CHECK_FALSE(lock_step::decode_go(bad));
  }
  CHECK(lock_step::is_begin(lock_step::begin()));
  CHECK(lock_step::is_end(lock_step::end()));
  CanFrame other_version = lock_step::begin();
  other_version.data[0] = lock_step::kVersion + 1;
  CHECK_FALSE(lock_step::is_begin(other_version));
  for (const CanFrame& frame :
       {lock_step::begin(), encode(Go{}), encode(Done{}), lock_step::end(), other_version}) {
    CHECK(lock_step::is_any(frame));
  }
  CanFrame standard;
  standard.id = 0x021;
  CHECK_FALSE(lock_step::is_any(standard));
}
