#include "hil_bridge/wires.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <vector>

#include "hal/can_timing.h"
#include "tests/hil_bridge/rigid_bench.h"

using namespace hoof;
using bridge::Wires;
using test::SeenFrame;

namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

hal::CanFrame frame_of(std::uint32_t id, int length) {
  hal::CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(length);
  return frame;
}

struct Recorded {
  std::vector<SeenFrame> seen;
  std::unique_ptr<Wires> wires =
      bridge::in_process_wires([this](int bus, const hal::CanFrame& frame) {
        seen.push_back({bus, frame});
      });
};

}  // namespace

TEST_CASE("frames of both buses reach the observer in the order of time") {
  Recorded r;
  hal::CanBus& on_bus0 = r.wires->attach(0, "a");
  hal::CanBus& on_bus1 = r.wires->attach(1, "a");
  // Two long frames against three short ones: their ends interleave.
  for (int i = 0; i < 2; ++i) on_bus0.send(frame_of(0x100 + i, 8));
  for (int i = 0; i < 3; ++i) on_bus1.send(frame_of(0x200 + i, 0));
  r.wires->advance_to(kMillisecond_ns);
  REQUIRE(r.seen.size() == 5);
  CHECK(r.wires->frames() == 5);
  std::vector<int> buses;
  for (std::size_t i = 0; i < r.seen.size(); ++i) {
    buses.push_back(r.seen[i].bus);
    CHECK((r.seen[i].frame.id >> 8) == (r.seen[i].bus == 0 ? 1 : 2));
    if (i > 0) CHECK(r.seen[i].frame.stamp_ns >= r.seen[i - 1].frame.stamp_ns);
  }
  // About 130 bits a long frame, 55 a short one: ends at 55, 113, 130, 171, 260 us.
  CHECK(buses == std::vector<int>{1, 1, 0, 1, 0});
}

TEST_CASE("of frames that end together bus 0 comes first, so that a log is the same every time") {
  Recorded r;
  hal::CanBus& on_bus1 = r.wires->attach(1, "a");
  hal::CanBus& on_bus0 = r.wires->attach(0, "a");
  on_bus1.send(frame_of(0x10, 4));
  on_bus0.send(frame_of(0x10, 4));
  r.wires->advance_to(kMillisecond_ns);
  REQUIRE(r.seen.size() == 2);
  CHECK(r.seen[0].frame.stamp_ns == r.seen[1].frame.stamp_ns);
  CHECK(r.seen[0].bus == 0);
  CHECK(r.seen[1].bus == 1);
}

TEST_CASE("a frame arrives at its end, at the other nodes of its own bus") {
  Recorded r;
  hal::CanBus& sender = r.wires->attach(0, "sender");
  hal::CanBus& receiver = r.wires->attach(0, "receiver");
  hal::CanBus& elsewhere = r.wires->attach(1, "elsewhere");
  sender.send(frame_of(0x123, 8));
  hal::CanFrame frame;
  r.wires->advance_to(50'000);  // 50 bits of at least 111
  CHECK_FALSE(receiver.receive(frame));
  r.wires->advance_to(200'000);
  CHECK(receiver.receive(frame));
  CHECK(frame.id == 0x123);
  CHECK_FALSE(sender.receive(frame));
  CHECK_FALSE(elsewhere.receive(frame));
}

TEST_CASE("load is the share of time that the frames of one bus take, intermission included") {
  Recorded r;
  hal::CanBus& sender = r.wires->attach(0, "sender");
  const hal::CanFrame frame = frame_of(0x555, 8);
  double bits = 0;
  for (int tick = 1; tick <= 40; ++tick) {
    if (tick > 20 && tick <= 30) {  // busy for exactly 10 ms
      for (int i = 0; i < 3; ++i) {
        sender.send(frame);
        bits += hal::frame_bits(frame).total();
      }
    }
    r.wires->advance_to(tick * kMillisecond_ns);
  }
  CHECK(r.wires->load_ratio(0) == Approx(bits / 40e3));
  CHECK(r.wires->worst_load_ratio(0) == Approx(bits / 10e3));
  CHECK(r.wires->load_ratio(1) == 0);
  CHECK(r.wires->worst_load_ratio(1) == 0);
}

TEST_CASE("a CAN interface that is not there is an error that names it") {
  // Without CAN in the kernel the reason differs; the name is told in any case.
  CHECK_THROWS_WITH(bridge::socketcan_wires("nocan7", {}), Catch::StartsWith("nocan7: "));
  CHECK_THROWS_AS(bridge::socketcan_wires("nocan7,nocan8", {}), std::runtime_error);
}
