// Several nodes that send the same identifier at the same time.
#include <catch2/catch.hpp>

#include "hal/in_process/in_process_bus.h"
#include "tests/hal/in_process/bus_fixture.h"

namespace hoof::hal {

using test::frame;
using test::Ids;
using test::kIntermission_ns;
using test::Wire;

TEST_CASE("equal frames overlay: one frame on the wire, both sent", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& listener = bus.attach("listener");
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  a.send(frame(0x80, {7}));
  b.send(frame(0x80, {7}));
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x80});
  CHECK(wire.entries[0].sender == 1);
  CHECK(a.status().sent == 1);
  CHECK(b.status().sent == 1);
  CHECK(a.pending() == 0);
  CHECK(b.pending() == 0);
  CanFrame got;
  CHECK_FALSE(a.receive(got));
  CHECK_FALSE(b.receive(got));
  CHECK(listener.receive(got));
  CHECK_FALSE(listener.receive(got));
  CHECK(bus.error_frames() == 0);
}

TEST_CASE("different frames under one identifier destroy each other until one side is passive",
          "[in_process]") {
  // Either order of attaching: the outcome depends on the bits, not on who was there first.
  const bool dominant_first = GENERATE(true, false);
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& first = bus.attach("first");
  InProcessPort& second = bus.attach("second");
  InProcessPort& listener = bus.attach("listener");
  InProcessPort& dominant = dominant_first ? first : second;
  InProcessPort& recessive = dominant_first ? second : first;
  dominant.send(frame(0x000, {0x00}));
  recessive.send(frame(0x000, {0x01}));

  // 31 bits up to the difference (see can_timing_test), then the error frame of 23 with
  // intermission.
  const std::int64_t attempt_ns = 54'000;
  CHECK(bus.next_event_ns() == attempt_ns - kIntermission_ns);
  bus.advance_to(attempt_ns);
  CHECK(bus.error_frames() == 1);
  CHECK(wire.entries.empty());
  CHECK(dominant.status().transmit_error_count == 8);
  CHECK(recessive.status().transmit_error_count == 8);
  CHECK(listener.status().receive_error_count == 1);
  CHECK(listener.status().error_frames == 1);
  CHECK(bus.load().busy_ns(bus.now_ns()) == attempt_ns);

  // 16 attempts of 8 make both passive; the 17th goes through for the dominant side.
  bus.advance_to(16 * attempt_ns);
  CHECK(bus.error_frames() == 16);
  CHECK(recessive.status().error_passive);
  CHECK(wire.entries.empty());
  bus.advance_to(16 * attempt_ns + 1'000'000);
  CHECK(bus.error_frames() == 16);
  REQUIRE(wire.entries.size() == 2);
  CHECK(wire.entries[0].start_ns == 16 * attempt_ns);
  CHECK(wire.entries[0].frame.data[0] == 0x00);
  CHECK(wire.entries[0].sender == dominant.index());
  CHECK(wire.entries[1].frame.data[0] == 0x01);
  CHECK(wire.entries[1].sender == recessive.index());
  CHECK(dominant.status().transmit_error_count == 127);  // 128 - 1: active again
  CHECK_FALSE(dominant.status().error_passive);
  CHECK(recessive.status().transmit_error_count == 135);  // 128 + 8 - 1
  CHECK(listener.status().receive_error_count == 14);     // 16 - 2
}

TEST_CASE("a node whose frames are always beaten leaves the bus, once", "[in_process]") {
  InProcessBus bus({});
  InProcessPort& rude = bus.attach("rude");
  InProcessPort& beaten = bus.attach("beaten");
  InProcessPort& listener = bus.attach("listener");
  int rounds = 0;
  while (!beaten.status().bus_off && rounds < 100) {
    rude.send(frame(0x100, {0x00}));
    beaten.send(frame(0x100, {0x80}));
    beaten.send(frame(0x100, {0x81}));
    bus.advance_to(bus.now_ns() + 2'000'000);
    ++rounds;
  }
  CHECK(beaten.status().bus_off);
  CHECK(beaten.status().transmit_error_count == 255);
  CHECK(beaten.pending() == 0);
  CHECK(beaten.send(frame(0x100)) == SendResult::kBusOff);
  CHECK_FALSE(rude.status().bus_off);
  // The others go on.
  const auto sent_before = rude.status().sent;
  rude.send(frame(0x100, {0x00}));
  bus.advance_to(bus.now_ns() + 1'000'000);
  CHECK(rude.status().sent == sent_before + 1);
  Ids heard;
  for (CanFrame got; listener.receive(got);) heard.push_back(got.id);
  CHECK(heard.size() >= sent_before + 1);
  beaten.set_bus_off(false);
  CHECK(beaten.status().transmit_error_count == 0);
  CHECK(beaten.send(frame(0x101)) == SendResult::kQueued);
}

TEST_CASE("three rivals: the most dominant survives when the others are passive", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  InProcessPort& c = bus.attach("c");
  a.send(frame(0x050, {0xC0}));
  b.send(frame(0x050, {0x40}));
  c.send(frame(0x050, {0x80}));
  bus.advance_to(20'000'000);
  REQUIRE(wire.entries.size() == 3);
  CHECK(wire.entries[0].frame.data[0] == 0x40);
  CHECK(wire.entries[1].frame.data[0] == 0x80);
  CHECK(wire.entries[2].frame.data[0] == 0xC0);
  CHECK(bus.error_frames() == 16);
  CHECK(bus.idle());
}

TEST_CASE("a frame that loses arbitration is not an error", "[in_process]") {
  InProcessBus bus({});
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  a.send(frame(0x10));
  b.send(frame(0x11));
  bus.advance_to(1'000'000);
  CHECK(a.status().transmit_error_count == 0);
  CHECK(b.status().transmit_error_count == 0);
  CHECK(bus.error_frames() == 0);
}

}  // namespace hoof::hal
