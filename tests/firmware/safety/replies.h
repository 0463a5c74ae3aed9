// One joint's replies, as the watch on them sees them.
#pragma once

#include <catch2/catch.hpp>

#include "firmware/safety/reply_watch.h"

namespace hoof::firmware::safety {

using control::FaultBits;
using control::JointState;
using control::JointWish;

inline constexpr std::int64_t kMillisecond_ns = 1'000'000;

/// One joint's replies, a millisecond apart unless said otherwise.
struct Replies {
  std::size_t joint = 1;
  ReplyWatch watch;
  JointState state;
  JointWish passed;
  std::int64_t now_ns = 7'000 * kMillisecond_ns;
  bool gives_way = false;  // by the least there is: a joint whose torque changes is not on one code

  explicit Replies(std::size_t which) : joint(which) {
    state.received = state.referenced = true;
    place(joint == 2 ? -1.0f : 0.0f);
    watch.start(now_ns);
    for (int i = 0; i < 3; ++i) REQUIRE(next() == 0);
  }

  void place(float position_rad) { state.position_rad = state.reading_rad = position_rad; }

  FaultBits look(std::uint32_t ticks = 1) {
    return watch.inspect(kLimits[joint], kDrives[joint], state, passed, now_ns, ticks);
  }

  FaultBits next(std::uint32_t ticks = 1, std::int64_t elapsed_ns = kMillisecond_ns) {
    now_ns += elapsed_ns;
    state.received_ns = now_ns;
    if (gives_way) state.reading_rad += state.reading_rad > 0.0f ? -1e-6f : 1e-6f;
    return look(ticks);
  }

  FaultBits next_at(float reading_rad, float velocity_rad_s) {
    state.reading_rad = reading_rad;
    state.velocity_rad_s = velocity_rad_s;
    return next();
  }
};

}  // namespace hoof::firmware::safety
