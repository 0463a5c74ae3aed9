// Readings that stay on one code while the torque changes.

#include <catch2/catch.hpp>

#include "firmware/safety/reply_watch.h"
#include "tests/firmware/safety/replies.h"

using namespace hoof::firmware;
using namespace hoof::firmware::safety;
namespace fault = control::fault;

TEST_CASE("A reading on one code while the torque changes is found, from the eleventh reply on") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const float sign : {-1.0f, 1.0f}) {
      CAPTURE(joint, sign);
      const float bound_Nm = kLimits[joint].stuck_Nm;
      const auto settle = [&](Replies& r, float torque_Nm) {
        FaultBits found = 0;
        for (int i = 0; i < 50; ++i) {
          r.state.torque_Nm = i % 2 == 0 ? 0.0f : sign * torque_Nm;
          found |= r.next();
        }
        return found;
      };
      Replies inside(joint), beyond(joint), moves(joint);
      CHECK(settle(inside, bound_Nm) == 0);
      CHECK(settle(beyond, 1.01f * bound_Nm) == fault::kImplausibleReply);
      // A code of motion now and then is enough.
      for (int i = 0; i < 50; ++i) {
        moves.state.torque_Nm = i % 2 == 0 ? 0.0f : sign * 2.0f * bound_Nm;
        if (i % 5 == 0) moves.place(moves.state.reading_rad + 4e-4f);
        CHECK(moves.next() == 0);
      }
    }
  }
}

TEST_CASE(
    "A torque that has brought a rotor to rest does not count, one from the fifth reply on does") {
  for (std::size_t joint = 0; joint < 3; ++joint) {
    for (const float sign : {-1.0f, 1.0f}) {
      const float far_Nm = sign * 2.0f * kLimits[joint].stuck_Nm;
      // One reply with another torque: which of those on one code it is decides.
      for (int odd_one = 1; odd_one <= kStuckReplies + 1; ++odd_one) {
        CAPTURE(joint, sign, odd_one);
        Replies r(joint);
        r.place(r.state.reading_rad + 4e-4f);
        for (int reply = 1; reply <= kStuckReplies; ++reply) {
          r.state.torque_Nm = reply == odd_one ? far_Nm : 0.0f;
          REQUIRE(r.next() == 0);
        }
        r.state.torque_Nm = odd_one == kStuckReplies + 1 ? far_Nm : 0.0f;
        // Those of the settling are forgotten but for the last, which the others are held against.
        const bool counts = odd_one >= kSettlingReplies;
        CHECK(r.next() == (counts ? fault::kImplausibleReply : 0));
        r.state.error = 1;  // beside it, not instead
        CHECK(r.next() == (fault::kDriveError | (counts ? fault::kImplausibleReply : 0)));
      }
    }
  }
}
