#include "hal/in_process/in_process_bus.h"

#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

#include "tests/hal/in_process/bus_fixture.h"
#include "tests/hal/wire_reference.h"

namespace hoof::hal {

using test::extended_frame;
using test::frame;
using test::Ids;
using test::kIntermission_ns;
using test::Wire;

TEST_CASE("a frame arrives at the end of its EOF at everyone but its sender", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& sender = bus.attach("sender");
  InProcessPort& listener = bus.attach("listener");
  InProcessPort& other = bus.attach("other");
  bus.advance_to(7'000);
  REQUIRE(sender.send(frame(0)) == SendResult::kQueued);
  const std::int64_t end_ns = 7'000 + 53'000 - kIntermission_ns;  // 53 bits, see can_timing_test
  CHECK(bus.next_event_ns() == end_ns);

  CanFrame got;
  bus.advance_to(end_ns - 1);
  CHECK_FALSE(listener.receive(got));
  CHECK(bus.next_event_ns() == end_ns);
  bus.advance_to(end_ns);
  REQUIRE(listener.receive(got));
  CHECK(got == frame(0));
  CHECK(got.stamp_ns == end_ns);
  CHECK_FALSE(listener.receive(got));
  CHECK(other.receive(got));
  CHECK_FALSE(sender.receive(got));
  CHECK(sender.status().sent == 1);
  CHECK(listener.status().received == 1);
  REQUIRE(wire.entries.size() == 1);
  CHECK(wire.entries[0].start_ns == 7'000);
  CHECK(wire.entries[0].sender == 0);
  CHECK_FALSE(bus.idle());  // intermission
  bus.advance_to(60'000);
  CHECK(bus.idle());
  CHECK(bus.next_event_ns() == InProcessBus::kNever);
}

TEST_CASE("receive leaves the frame alone when nothing waits", "[in_process]") {
  InProcessBus bus({});
  InProcessPort& port = bus.attach("port");
  CanFrame got = frame(0x123, {1, 2});
  CHECK_FALSE(port.receive(got));
  CHECK(got == frame(0x123, {1, 2}));
}

TEST_CASE("among frames sent at one instant the lowest arbitration field goes first",
          "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  InProcessPort& c = bus.attach("c");
  a.send(frame(0x300));
  bus.advance_to(0);  // no time passes: nothing starts, others may still join
  CanFrame remote = frame(0x200);
  remote.remote = true;
  b.send(remote);
  b.send(frame(0x201));
  c.send(frame(0x200));
  c.send(extended_frame(0x200U << 18));
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x200, 0x200, 0x200U << 18, 0x201, 0x300});
  CHECK_FALSE(wire.entries[0].frame.remote);
  CHECK(wire.entries[1].frame.remote);
  // Back to back: each starts right behind the intermission of the one before.
  for (std::size_t i = 1; i < wire.entries.size(); ++i) {
    CHECK(wire.entries[i].start_ns == wire.entries[i - 1].end_ns + kIntermission_ns);
  }
}

TEST_CASE("a frame on the wire is never interrupted, whatever comes", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  a.send(frame(0x700, {1, 2, 3, 4, 5, 6, 7, 8}));
  bus.advance_to(1);
  b.send(frame(0x001));
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x700, 0x001});
}

TEST_CASE("what is sent on reception or in the intermission takes part in the next arbitration",
          "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  a.send(frame(0x100));
  a.send(frame(0x300));
  bus.advance_to(bus.next_event_ns());
  CanFrame got;
  REQUIRE(b.receive(got));
  b.send(frame(0x200));  // beats 0x300, which has waited longer
  bus.advance_to(bus.next_event_ns());
  CHECK(wire.ids() == Ids{0x100, 0x200});
  CHECK(wire.entries[1].start_ns == wire.entries[0].end_ns + kIntermission_ns);
  bus.advance_to(bus.now_ns() + kIntermission_ns);  // the wire is free at this very instant
  b.send(frame(0x201));
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x100, 0x200, 0x201, 0x300});
}

TEST_CASE("an observer may answer and is heard at once", "[in_process]") {
  std::vector<std::int64_t> ends;
  InProcessPort* drive = nullptr;
  InProcessBus bus({}, [&](const WireRecord& record) {
    ends.push_back(record.end_ns);
    if (record.frame.id == 0x10) drive->send(frame(0x20));
  });
  InProcessPort& master = bus.attach("master");
  drive = &bus.attach("drive");
  master.send(frame(0x10));
  bus.advance_to(1'000'000);
  REQUIRE(ends.size() == 2);
  CanFrame got;
  REQUIRE(master.receive(got));
  CHECK(got.id == 0x20);
  CHECK(got.stamp_ns - ends[0] == frame_time_ns(frame(0x20)));
}

TEST_CASE("three mailboxes: lowest field first, equal ones in order, then full", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& port = bus.attach("port");
  CHECK(port.send(frame(0x123, {1})) == SendResult::kQueued);
  CHECK(port.send(frame(0x123, {0})) == SendResult::kQueued);
  CHECK(port.send(frame(0x122)) == SendResult::kQueued);
  CHECK(port.send(frame(0x001)) == SendResult::kFull);
  CHECK(port.pending() == 3);
  bus.advance_to(1);  // 0x122 is on the wire and keeps its mailbox until its end
  CHECK(port.send(frame(0x001)) == SendResult::kFull);
  bus.advance_to(bus.next_event_ns());
  CHECK(port.send(frame(0x001)) == SendResult::kQueued);
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x122, 0x001, 0x123, 0x123});
  CHECK(wire.entries[2].frame.data[0] == 1);
  CHECK(wire.entries[3].frame.data[0] == 0);
  CHECK(port.pending() == 0);
}

TEST_CASE("what waits under one identifier can be withdrawn, what is on the wire cannot",
          "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& port = bus.attach("port");
  auto extended = frame(0x022, {9});
  extended.extended = true;
  REQUIRE(port.send(frame(0x022, {1})) == SendResult::kQueued);
  REQUIRE(port.send(frame(0x023, {2})) == SendResult::kQueued);
  REQUIRE(port.send(extended) == SendResult::kQueued);
  port.withdraw(0x022);
  CHECK(port.pending() == 2);
  REQUIRE(port.send(frame(0x022, {3})) == SendResult::kQueued);
  bus.advance_to(bus.next_event_ns());   // the extended one: its first eleven bits are 0
  bus.advance_to(bus.now_ns() + 3'001);  // behind the intermission
  port.withdraw(0x022);                  // too late: it is on the wire
  port.withdraw(0x7FF);
  CHECK(port.pending() == 2);
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x022, 0x022, 0x023});
  CHECK(wire.entries[0].frame.data[0] == 9);
  CHECK(wire.entries[1].frame.data[0] == 3);
  CHECK(bus.idle());
}

TEST_CASE("a node that never stops starves lower priorities and is starved by none",
          "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& babbler = bus.attach("babbler");
  InProcessPort& meek = bus.attach("meek");
  InProcessPort& urgent = bus.attach("urgent");
  meek.send(frame(0x400));
  while (bus.now_ns() < 10'000'000) {
    while (babbler.send(frame(0x200)) == SendResult::kQueued) {
    }
    bus.advance_to(bus.next_event_ns());
  }
  CHECK(meek.status().sent == 0);
  CHECK(bus.mean_load_ratio() > 0.99);
  urgent.send(frame(0x100));
  bus.advance_to(bus.now_ns() + 2 * frame_time_ns(frame(0x200)));
  CHECK(urgent.status().sent == 1);
  CHECK(meek.status().sent == 0);
  bus.advance_to(bus.now_ns() + 5 * frame_time_ns(frame(0x200)));  // the babbler has stopped
  CHECK(meek.status().sent == 1);
}

TEST_CASE("frames beyond the queue are lost, counted, and the oldest are kept", "[in_process]") {
  InProcessBusSettings settings;
  settings.receive_queue = 5;
  InProcessBus bus(settings);
  InProcessPort& sender = bus.attach("sender");
  InProcessPort& sleeper = bus.attach("sleeper");
  const auto send_some = [&](std::uint8_t first, std::uint8_t last) {
    for (std::uint8_t i = first; i <= last; ++i) {
      sender.send(frame(0x10, {i}));
      bus.advance_to(bus.now_ns() + 200'000);
    }
  };
  const auto read_some = [&](int count) {
    std::vector<int> out;
    for (CanFrame got; count-- > 0 && sleeper.receive(got);) out.push_back(got.data[0]);
    return out;
  };
  send_some(0, 7);
  CHECK(sleeper.status().dropped == 3);
  CHECK(read_some(3) == std::vector<int>{0, 1, 2});
  send_some(8, 11);  // 3 places free; the ring wraps
  CHECK(sleeper.status().dropped == 4);
  CHECK(read_some(99) == std::vector<int>{3, 4, 8, 9, 10});
  CHECK(sleeper.status().received == 8);
  CHECK(sender.status().sent == 12);
}

TEST_CASE("frames that cannot exist are refused and leave no trace", "[in_process]") {
  InProcessBus classic({});
  InProcessPort& port = classic.attach("port");
  CanFrame fd = frame(0x10);
  fd.fd = true;
  CHECK(port.send(fd) == SendResult::kInvalid);
  CHECK(port.send(frame(0x800)) == SendResult::kInvalid);
  CHECK(port.pending() == 0);
  CHECK(classic.next_event_ns() == InProcessBus::kNever);

  InProcessBusSettings settings;
  settings.fd = true;
  InProcessBus bus(settings);
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  fd.length = 64;
  fd.bit_rate_switch = true;
  CHECK(a.send(fd) == SendResult::kQueued);
  CHECK(bus.next_event_ns() == frame_time_ns(fd) - kIntermission_ns);
  bus.advance_to(bus.next_event_ns());
  CanFrame got;
  REQUIRE(b.receive(got));
  CHECK(got == fd);
  fd.length = 9;
  CHECK(a.send(fd) == SendResult::kInvalid);
}

TEST_CASE("filters pass what they name and count nothing else as lost", "[in_process]") {
  InProcessBus bus({});
  InProcessPort& sender = bus.attach("sender");
  InProcessPort& choosy = bus.attach("choosy");
  choosy.set_filters({{0x100, 0x7F0, false}, {0x300, 0x7FF, false}});
  for (const std::uint32_t id : {0x100U, 0x10FU, 0x110U, 0x300U, 0x301U}) {
    sender.send(frame(id));
    bus.advance_to(bus.now_ns() + 200'000);
  }
  Ids ids;
  for (CanFrame got; choosy.receive(got);) ids.push_back(got.id);
  CHECK(ids == Ids{0x100, 0x10F, 0x300});
  CHECK(choosy.status().dropped == 0);
}

TEST_CASE("bus-off loses what waits, hears nothing, and ends on demand", "[in_process]") {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  InProcessPort& a = bus.attach("a");
  InProcessPort& b = bus.attach("b");
  a.send(frame(0x10));
  a.send(frame(0x11));
  bus.advance_to(1);
  a.set_bus_off(true);
  CHECK(a.status().bus_off);
  CHECK(a.send(frame(0x12)) == SendResult::kBusOff);
  CHECK(a.pending() == 1);  // 0x10 is on the wire
  b.send(frame(0x20));
  bus.advance_to(1'000'000);
  CHECK(wire.ids() == Ids{0x10, 0x20});
  CanFrame got;
  CHECK_FALSE(a.receive(got));
  a.set_bus_off(false);
  CHECK(a.send(frame(0x12)) == SendResult::kQueued);
  b.send(frame(0x21));
  bus.advance_to(2'000'000);
  CHECK(wire.ids() == Ids{0x10, 0x20, 0x12, 0x21});
  REQUIRE(a.receive(got));
  CHECK(got.id == 0x21);
}

TEST_CASE("counts per identifier and in total", "[in_process]") {
  InProcessBus bus({});
  InProcessPort& port = bus.attach("port");
  for (int i = 0; i < 7; ++i) {
    port.send(i % 3 == 0 ? extended_frame(0x7F) : frame(0x7F));
    bus.advance_to(bus.now_ns() + 200'000);
  }
  CHECK(bus.frames() == 7);
  CHECK(bus.frames_of(0x7F) == 4);
  CHECK(bus.frames_of(0x7F, true) == 3);
  CHECK(bus.frames_of(0x7E) == 0);
  CHECK(bus.frames_of(0x12345678) == 0);
}

TEST_CASE("impossible settings name the rule and the value", "[in_process]") {
  InProcessBusSettings settings;
  settings.name = "bus1";
  settings.mailboxes = 0;
  CHECK_THROWS_WITH(InProcessBus(settings), "bus1: mailboxes must be 1 to 8, but it is 0");
  settings.mailboxes = 3;
  settings.bit_rates.nominal_Hz = 2'000'000;
  CHECK_THROWS_AS(InProcessBus(settings), std::invalid_argument);
  settings.bit_rates = {500'000, 250'000};
  CHECK_THROWS_AS(InProcessBus(settings), std::invalid_argument);
  settings.bit_rates = {};
  settings.receive_queue = 0;
  CHECK_THROWS_AS(InProcessBus(settings), std::invalid_argument);
}

namespace {

/// Random traffic of five nodes. `split_at` > 0 additionally stops the bus at multiples of that
/// time.
Wire random_traffic(unsigned seed, std::int64_t split_every_ns) {
  Wire wire;
  InProcessBus bus({}, wire.observer());
  std::vector<InProcessPort*> ports;
  for (int i = 0; i < 5; ++i) ports.push_back(&bus.attach("node"));
  std::mt19937 random(seed);
  std::int64_t t_ns = 0;
  for (int i = 0; i < 4'000; ++i) {
    t_ns += static_cast<std::int64_t>(random() % 200'000);
    if (split_every_ns > 0) {
      while (bus.now_ns() + split_every_ns < t_ns) bus.advance_to(bus.now_ns() + split_every_ns);
    }
    bus.advance_to(t_ns);
    const unsigned node = random() % 5;
    CanFrame sent = test::random_classic_frame(random);
    if (!sent.extended) sent.id = (sent.id & 0x7F8U) | node;  // identifiers are not shared
    if (sent.extended) sent.id = (sent.id & ~7U) | node;
    ports[node]->send(sent);
  }
  bus.advance_to(t_ns + 100'000'000);
  REQUIRE(bus.idle());
  REQUIRE(bus.frames() == wire.entries.size());
  std::int64_t busy_ns = 0;
  for (const Wire::Entry& entry : wire.entries) busy_ns += frame_time_ns(entry.frame);
  CHECK(bus.load().busy_ns(bus.now_ns()) == busy_ns);  // load is the sum of the frame times
  return wire;
}

}  // namespace

TEST_CASE("random traffic: no overlap, exact durations, the same again however time is cut",
          "[in_process]") {
  const unsigned seed = 77;
  INFO("seed " << seed);
  const Wire wire = random_traffic(seed, 0);
  CHECK(wire.entries.size() > 3'000);
  std::int64_t free_at_ns = 0;
  bool ok = true;
  for (const Wire::Entry& entry : wire.entries) {
    ok = ok && entry.start_ns >= free_at_ns;
    free_at_ns = entry.end_ns + kIntermission_ns;
    ok = ok && free_at_ns - entry.start_ns == frame_time_ns(entry.frame);
    ok = ok && entry.frame.stamp_ns == entry.end_ns;
  }
  CHECK(ok);
  CHECK(random_traffic(seed, 0).entries == wire.entries);
  CHECK(random_traffic(seed, 3'333).entries == wire.entries);
  CHECK_FALSE(random_traffic(seed + 1, 0).entries == wire.entries);
}

}  // namespace hoof::hal
