#include "firmware/app/inbox.h"

#include <catch2/catch.hpp>
#include <deque>

using namespace hoof::firmware;
using app::Inbox;
using control::Joint;
using hoof::hal::CanFrame;

namespace {

/// Frames put in come out; nothing else.
class Row final : public hoof::hal::CanBus {
 public:
  std::deque<CanFrame> frames;
  hoof::hal::SendResult send(const CanFrame&) override { return hoof::hal::SendResult::kDown; }
  bool receive(CanFrame& frame) override {
    if (frames.empty()) return false;
    frame = frames.front();
    frames.pop_front();
    return true;
  }
  hoof::hal::BusStatus status() const override { return {}; }
};

struct Post {
  app::Counters counters;
  Inbox inbox{counters};
  Row row;

  void deliver(const CanFrame& frame, int bus_index, std::int64_t now_ns = 5) {
    row.frames.push_back(frame);
    inbox.drain(row, bus_index, now_ns);
  }
};

}  // namespace

TEST_CASE("A reply becomes a joint state with its time, on its own bus only") {
  Post post;
  const CanFrame hip = encode_reply(protocol::Drive::kHip, {0, 0.7f, -1.5f, 120.0f, 41.0f, 2});
  post.deliver(hip, 0);
  CHECK(post.counters.unknown_frames == 1);
  CHECK_FALSE(post.inbox.joints()[1].received);
  post.deliver(hip, 1, 77);
  const control::JointState& state = post.inbox.joints()[1];
  CHECK(state.received);
  CHECK(state.received_ns == 77);
  CHECK(state.position_rad == Approx(0.7f).margin(1e-4));
  CHECK(state.velocity_rad_s == Approx(-1.5f).margin(5e-3));
  CHECK(state.torque_Nm == Approx(120.0f).margin(0.1));
  CHECK(state.temperature_C == 41.0f);
  CHECK(state.error == 2);
}

TEST_CASE("A zero moves present and later angles; the reading stays") {
  Post post;
  post.inbox.set_zero(Joint::kToe, 0.5f);
  CHECK(post.inbox.joints()[0].position_rad == 0.0f);  // nothing was read yet
  const CanFrame toe = encode_reply(protocol::Drive::kToe, {0, 2.0f, 0, 0, 25, 0});
  post.deliver(toe, 0);
  CHECK(post.inbox.joints()[0].position_rad == Approx(1.5f).margin(2e-4));
  CHECK(post.inbox.joints()[0].reading_rad == Approx(2.0f).margin(2e-4));  // a code is 3.8e-4
  post.inbox.set_zero(Joint::kToe, 1.5f);
  CHECK(post.inbox.joints()[0].position_rad == Approx(0.5f).margin(2e-4));
  post.deliver(toe, 0);
  CHECK(post.inbox.joints()[0].position_rad == Approx(0.5f).margin(2e-4));
  CHECK(post.inbox.zero_rad(Joint::kToe) == 1.5f);
}

TEST_CASE("Connections, requests and writes are handed out once each; broken ones are counted") {
  Post post;
  const auto frames = {
      encode(protocol::SupervisorConnect{7, 0x12345678, 9}),
      encode(protocol::ParameterWrite{7, 3, 0x3F800000, 1}),
      encode(protocol::ServiceRequest{7, protocol::Service::kReadFaultLog, 2, 300, 0, 4})};
  for (const CanFrame& frame : frames) {
    post.deliver(frame, 0);
    CanFrame broken = frame;
    broken.data[2] ^= 1;
    post.deliver(broken, 0);
    post.deliver(frame, 1);  // supervisors are on bus 0
  }
  CHECK(post.counters.bad_crc_frames == 3);
  CHECK(post.counters.unknown_frames == 3);
  CHECK(post.inbox.take_connect()->protocol_hash == 0x12345678);
  CHECK(post.inbox.take_write()->value == 0x3F800000);
  CHECK(post.inbox.take_request()->offset == 300);
  CHECK_FALSE(post.inbox.take_connect().has_value());
  CHECK_FALSE(post.inbox.take_write().has_value());
  CHECK_FALSE(post.inbox.take_request().has_value());
}

TEST_CASE("SYNC: only forward, only from bus 0, over the end of the numbers") {
  Post post;
  const auto sync = [](std::uint32_t n) { return encode(protocol::Sync{n}); };
  post.deliver(sync(3), 1);
  CHECK_FALSE(post.inbox.take_sync().has_value());
  post.deliver(sync(0xFFFFFFFFu), 0);
  CHECK(post.inbox.take_sync() == 0xFFFFFFFFu);
  CHECK_FALSE(post.inbox.take_sync().has_value());
  post.deliver(sync(0), 0);
  CHECK(post.inbox.take_sync() == 0u);
  CHECK(post.counters.missed_ticks == 0);
  post.deliver(sync(0xFFFFFFFFu), 0);
  CHECK_FALSE(post.inbox.take_sync().has_value());
  CHECK(post.counters.stale_syncs == 1);
  // Two waiting: the newer one counts, the older is lost.
  post.row.frames = {sync(1), sync(2)};
  post.inbox.drain(post.row, 0, 9);
  CHECK(post.inbox.take_sync() == 2u);
  CHECK(post.counters.missed_ticks == 1);
  post.inbox.forget_sync();
  post.deliver(sync(0), 0);
  CHECK(post.inbox.take_sync() == 0u);
}

TEST_CASE("An e-stop counts on both buses, at any length, once") {
  for (const int bus : {0, 1}) {
    Post post;
    CanFrame frame;
    frame.id = 0x001;
    frame.length = 3;
    post.deliver(frame, bus);
    CHECK(post.inbox.take_emergency_stop());
    CHECK_FALSE(post.inbox.take_emergency_stop());
    frame.extended = true;  // another identifier altogether
    post.deliver(frame, bus);
    CHECK_FALSE(post.inbox.take_emergency_stop());
  }
}

TEST_CASE("Odd frames are told apart in the counters") {
  Post post;
  CanFrame frame = encode(protocol::Sync{1});
  frame.length = 3;
  post.deliver(frame, 0);
  frame.length = 5;
  post.deliver(frame, 0);
  CHECK(post.counters.malformed_frames == 2);
  frame = encode(protocol::SupervisorOrder{});
  frame.data[0] ^= 1;
  post.deliver(frame, 0);
  CHECK(post.counters.bad_crc_frames == 1);
  frame.id = 0x555;
  post.deliver(frame, 0);
  CHECK(post.counters.unknown_frames == 1);
  CHECK(post.counters.bad_frames() == 4);
  CHECK(post.counters.frames == 0);
}

TEST_CASE("More orders than can wait are dropped, not mixed up") {
  Post post;
  for (std::uint8_t n = 0; n < 10; ++n) {
    post.row.frames.push_back(
        encode(protocol::SupervisorOrder{1, protocol::Order::kReady, 0, 0, n}));
  }
  post.inbox.drain(post.row, 0, 5);
  for (std::uint8_t n = 0; n < 4; ++n) CHECK(post.inbox.take_order()->order.counter == n);
  CHECK_FALSE(post.inbox.take_order().has_value());
}
