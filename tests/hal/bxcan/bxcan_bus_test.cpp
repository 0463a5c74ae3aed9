#include "hal/bxcan/bxcan_bus.h"

#include <catch2/catch.hpp>
#include <random>

#include "hal/bxcan/filters.h"
#include "tests/hal/bxcan/simulated_bxcan.h"

using namespace hoof;
using hal::CanFrame;
using hal::SendResult;
using hal::bxcan::BxCanBus;
using tests::SimulatedBxCan;
using tests::SimulatedFrame;

namespace {

constexpr std::uint32_t kTiming = 0x011A'0002;
constexpr std::int64_t kMs = 1'000'000;

CanFrame data_frame(std::uint32_t id, std::initializer_list<std::uint8_t> bytes = {}) {
  CanFrame frame;
  frame.id = id;
  for (const std::uint8_t byte : bytes) frame.data[frame.length++] = byte;
  return frame;
}

constexpr std::uint32_t standard(std::uint32_t id) {
  return id << 21;
}

struct Rig {
  SimulatedBxCan can;
  BxCanBus bus{can.registers};

  void join(std::int64_t now_ns = 0) {
    REQUIRE(bus.start(kTiming));
    bus.maintain(now_ns);
  }
  /// Identifiers that go out until nothing waits.
  std::vector<std::uint32_t> transmit_all() {
    std::vector<std::uint32_t> ids;
    while (const auto frame = can.transmit()) ids.push_back(frame->identifier >> 21);
    return ids;
  }
};

}  // namespace

TEST_CASE(
    "bxCAN starts with the timing given, in initialisation, and without recovery of its own") {
  Rig rig;
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kDown);
  REQUIRE(rig.bus.start(kTiming));
  CHECK(rig.can.registers.BTR.stored() == kTiming);
  // Neither sleep, nor request, nor ABOM, NART, TXFP, RFLM, TTCM, AWUM.
  CHECK((rig.can.registers.MCR.stored() & 0xFF) == 0);
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kDown);  // not joined yet
  rig.bus.maintain(0);
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kQueued);
  CHECK(rig.can.faults.empty());
}

TEST_CASE("bxCAN that is not there leaves the bus down after a bounded number of looks") {
  Rig rig;
  rig.can.present = false;
  CHECK_FALSE(rig.bus.start(kTiming));
  CHECK(rig.can.reads < 100'000);
  rig.bus.maintain(kMs);
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kDown);
  CanFrame frame;
  CHECK_FALSE(rig.bus.receive(frame));
  CHECK_FALSE(rig.bus.status().bus_off);
}

TEST_CASE("bxCAN on a wire that is never idle waits without blocking") {
  Rig rig;
  rig.can.hears_idle_bus = false;
  REQUIRE(rig.bus.start(kTiming));
  for (int ms = 0; ms < 1000; ++ms) rig.bus.maintain(ms * kMs);
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kDown);
  rig.can.hears_idle_bus = true;
  rig.can.on_write(rig.can.registers.MCR, rig.can.registers.MCR.stored());
  rig.bus.maintain(1001 * kMs);
  CHECK(rig.bus.send(data_frame(1)) == SendResult::kQueued);
}

TEST_CASE("bxCAN sends the smallest identifier first, three at a time") {
  Rig rig;
  rig.join();
  CHECK(rig.bus.send(data_frame(0x064)) == SendResult::kQueued);
  CHECK(rig.bus.send(data_frame(0x021)) == SendResult::kQueued);
  CHECK(rig.bus.send(data_frame(0x050)) == SendResult::kQueued);
  CHECK(rig.bus.send(data_frame(0x001)) == SendResult::kFull);
  CHECK(rig.transmit_all() == std::vector<std::uint32_t>{0x021, 0x050, 0x064});
  CHECK(rig.bus.send(data_frame(0x001)) == SendResult::kQueued);
}

TEST_CASE("bxCAN puts bytes and length where the peripheral wants them") {
  Rig rig;
  rig.join();
  CanFrame frame = data_frame(0x123, {1, 2, 3, 4, 5, 6, 7});
  REQUIRE(rig.bus.send(frame) == SendResult::kQueued);
  auto sent = rig.can.transmit();
  CHECK(sent->identifier == 0x123u << 21);
  CHECK(sent->length == 7);
  CHECK(sent->low == 0x0403'0201);
  CHECK(sent->high == 0x0007'0605);

  frame.extended = true;
  frame.id = 0x1FFF'FFFF;
  frame.remote = true;
  REQUIRE(rig.bus.send(frame) == SendResult::kQueued);
  sent = rig.can.transmit();
  CHECK(sent->identifier == ((0x1FFF'FFFFu << 3) | 4 | 2));

  frame.fd = true;
  frame.remote = false;
  CHECK(rig.bus.send(frame) == SendResult::kInvalid);
  CHECK(rig.bus.send(data_frame(0x800)) == SendResult::kInvalid);
  CHECK_FALSE(rig.can.transmit().has_value());
}

TEST_CASE("bxCAN keeps frames of one identifier in the order of sending") {
  // An exit frame must not overtake the command before it, nor be overtaken by one after it.
  Rig rig;
  rig.join();
  REQUIRE(rig.bus.send(data_frame(0x010)) == SendResult::kQueued);       // mailbox 0
  REQUIRE(rig.bus.send(data_frame(0x021, {1})) == SendResult::kQueued);  // mailbox 1
  REQUIRE(rig.can.transmit()->identifier == standard(0x010));            // 0 is empty again
  REQUIRE(rig.bus.send(data_frame(0x021, {2})) == SendResult::kQueued);  // above, not into 0
  CHECK(rig.bus.send(data_frame(0x021, {3})) == SendResult::kFull);      // though 0 is empty
  CHECK(rig.bus.send(data_frame(0x040)) == SendResult::kQueued);         // others may
  CHECK(rig.can.transmit()->low == 1);
  CHECK(rig.can.transmit()->low == 2);
  CHECK(rig.can.transmit()->identifier == standard(0x040));
}

TEST_CASE("bxCAN: random sending keeps priority and order, and loses nothing") {
  const auto seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(seed);
  std::mt19937 random(seed);
  Rig rig;
  rig.join();
  struct Waiting {
    std::uint32_t id;
    std::uint32_t number;
  };
  std::vector<Waiting> waiting;  // in the order of sending
  std::uint32_t number = 0;
  std::uint64_t sent = 0;
  for (int i = 0; i < 20'000; ++i) {
    if (random() % 2 == 0) {
      const std::uint32_t id = 0x20 + random() % 4;
      CanFrame frame = data_frame(id, {0, 0, 0, 0});
      for (unsigned b = 0; b < 4; ++b) frame.data[b] = static_cast<std::uint8_t>(number >> 8 * b);
      const SendResult result = rig.bus.send(frame);
      if (result == SendResult::kQueued) waiting.push_back({id, number++});
      // Full for want of a mailbox, or because its place in the order is taken.
      if (waiting.empty()) REQUIRE(result == SendResult::kQueued);
      REQUIRE(waiting.size() <= 3);
    } else if (const auto frame = rig.can.transmit()) {
      auto expected = waiting.begin();
      for (auto it = waiting.begin(); it != waiting.end(); ++it) {
        if (it->id < expected->id) expected = it;
      }
      REQUIRE(frame->identifier == standard(expected->id));
      REQUIRE(frame->low == expected->number);
      waiting.erase(expected);
      ++sent;
      rig.bus.on_transmit_interrupt();
    } else {
      REQUIRE(waiting.empty());
    }
  }
  CHECK(rig.bus.status().sent == sent);
  CHECK(sent > 5'000);
  CHECK(rig.can.faults.empty());
}

TEST_CASE("bxCAN withdraws what waits under one identifier, and nothing else") {
  Rig rig;
  rig.join();
  REQUIRE(rig.bus.send(data_frame(0x022, {1})) == SendResult::kQueued);
  REQUIRE(rig.bus.send(data_frame(0x023, {2})) == SendResult::kQueued);
  CanFrame other = data_frame(0x022, {3});
  other.extended = true;
  REQUIRE(rig.bus.send(other) == SendResult::kQueued);
  rig.bus.withdraw(0x7FF);
  CHECK(rig.bus.send(data_frame(0x022)) == SendResult::kFull);
  rig.bus.withdraw(0x022);
  REQUIRE(rig.bus.send(data_frame(0x022, {4})) == SendResult::kQueued);
  CHECK(rig.can.transmit()->low == 3);  // extended: its first eleven bits are 0
  CHECK(rig.can.transmit()->low == 4);
  CHECK(rig.can.transmit()->low == 2);
  CHECK_FALSE(rig.can.transmit());
  rig.bus.withdraw(0x022);  // nothing is left of it
  CHECK(rig.bus.send(data_frame(0x022)) == SendResult::kQueued);
}

TEST_CASE("bxCAN counts what was acknowledged as sent, not what was aborted") {
  Rig rig;
  rig.join();
  REQUIRE(rig.bus.send(data_frame(0x30)) == SendResult::kQueued);
  REQUIRE(rig.bus.send(data_frame(0x31)) == SendResult::kQueued);
  rig.can.transmit();
  rig.bus.on_transmit_interrupt();
  rig.bus.on_transmit_interrupt();
  CHECK(rig.bus.status().sent == 1);
  rig.can.on_write(rig.can.registers.TSR, hal::bxcan::tsr::kAbortAll);
  rig.bus.on_transmit_interrupt();
  CHECK(rig.bus.status().sent == 1);
}

TEST_CASE("bxCAN interrupts for a frame that left once, and only where one found no room") {
  Rig rig;
  rig.join();
  const auto on = [&] {
    return (rig.can.registers.IER.stored() & hal::bxcan::ier::kMailboxEmpty) != 0;
  };
  for (std::uint32_t id = 0x30; id < 0x33; ++id) {
    REQUIRE(rig.bus.send(data_frame(id)) == SendResult::kQueued);
    CHECK_FALSE(on());
  }
  CHECK(rig.bus.send(data_frame(0x33)) == SendResult::kFull);
  CHECK(on());
  rig.can.transmit();
  CHECK(on());
  rig.bus.on_transmit_interrupt();
  CHECK_FALSE(on());
  CHECK(rig.bus.send(data_frame(0x33)) == SendResult::kQueued);
  CHECK_FALSE(on());
  CHECK(rig.bus.status().sent == 1);
}

TEST_CASE("bxCAN empties both FIFOs in order, with the time of arrival") {
  Rig rig;
  rig.join();
  rig.can.receive(1, {standard(0x010), 4, 0x4433'2211, 0});
  rig.can.receive(1, {standard(0x031), 8, 1, 0x8877'6655});
  rig.bus.on_receive_interrupt(1, 5000);
  rig.can.receive(0, {standard(0x001), 1, 9, 0});
  rig.bus.on_receive_interrupt(0, 6000);
  CHECK(rig.bus.frame_waiting());
  CanFrame frame;
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame == data_frame(0x010, {0x11, 0x22, 0x33, 0x44}));
  CHECK(frame.stamp_ns == 5000);
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame == data_frame(0x031, {1, 0, 0, 0, 0x55, 0x66, 0x77, 0x88}));
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame == data_frame(0x001, {9}));
  CHECK(frame.stamp_ns == 6000);
  CHECK_FALSE(rig.bus.frame_waiting());
  const CanFrame before = frame;
  CHECK_FALSE(rig.bus.receive(frame));
  CHECK(frame == before);
  CHECK(rig.bus.status().received == 3);
  CHECK(rig.can.faults.empty());
}

TEST_CASE("bxCAN tells extended and remote frames, and lengths beyond eight") {
  Rig rig;
  rig.join();
  rig.can.receive(1, {(0x1234'5678u << 3) | 4, 2, 0xBBAA, 0});
  rig.can.receive(1, {standard(0x22) | 2, 8, 0xFFFF'FFFF, 0xFFFF'FFFF});
  rig.can.receive(1, {standard(0x23), 15 | 0xABCD'0000, 1, 2});
  rig.bus.on_receive_interrupt(1, 0);
  CanFrame frame;
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame.extended);
  CHECK(frame.id == 0x1234'5678);
  CHECK(frame.length == 2);
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame.remote);
  CHECK_FALSE(frame.extended);
  CHECK(frame.id == 0x22);
  CHECK(frame.data[0] == 0);
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame.length == 8);
}

TEST_CASE("bxCAN counts an overrun and goes on") {
  Rig rig;
  rig.join();
  for (std::uint32_t i = 0; i < 5; ++i) rig.can.receive(1, {standard(0x30 + i), 0, 0, 0});
  rig.bus.on_receive_interrupt(1, 0);
  CHECK(rig.bus.status().dropped == 1);
  CHECK((rig.can.registers.RFR[1].stored() & 0x10) == 0);
  std::vector<std::uint32_t> ids;
  for (CanFrame frame; rig.bus.receive(frame);) ids.push_back(frame.id);
  CHECK(ids == std::vector<std::uint32_t>{0x30, 0x31, 0x34});  // the newest is kept
}

TEST_CASE("bxCAN: a flood that nobody reads does not keep the e-stop out") {
  Rig rig;
  rig.join();
  for (int i = 0; i < 100; ++i) {
    rig.can.receive(1, {standard(0x010), 4, 0, 0});
    rig.bus.on_receive_interrupt(1, i);
  }
  rig.can.receive(0, {standard(0x001), 0, 0, 0});
  rig.bus.on_receive_interrupt(0, 100);
  const std::uint64_t kept =
      hal::bxcan::BxCanBus::Queue::kSize - hal::bxcan::BxCanBus::Queue::kUrgentPlaces;
  CHECK(rig.bus.status().dropped == 100 - kept);
  CanFrame frame;
  for (std::uint64_t i = 0; i < kept; ++i) {
    REQUIRE(rig.bus.receive(frame));
    CHECK(frame.stamp_ns == static_cast<std::int64_t>(i));
  }
  REQUIRE(rig.bus.receive(frame));
  CHECK(frame.id == 0x001);
  CHECK_FALSE(rig.bus.receive(frame));
  for (int i = 0; i < 40; ++i) {  // urgent frames end, too
    rig.can.receive(0, {standard(0x001), 0, 0, 0});
    rig.bus.on_receive_interrupt(0, i);
  }
  CHECK(rig.bus.status().dropped == 100 - kept + 8);
}

TEST_CASE("bxCAN reports error counters and counts errors once each") {
  Rig rig;
  rig.join();
  rig.bus.on_status_interrupt();
  CHECK(rig.bus.status().error_frames == 0);
  rig.can.error(3, 8, 1);
  rig.bus.on_status_interrupt();
  CHECK((rig.can.registers.MSR.stored() & 4) == 0);
  rig.bus.on_status_interrupt();  // no new one
  hal::BusStatus status = rig.bus.status();
  CHECK(status.error_frames == 1);
  CHECK(status.transmit_error_count == 8);
  CHECK(status.receive_error_count == 1);
  CHECK_FALSE(status.error_passive);
  rig.can.error(3, 128, 1);
  rig.bus.on_status_interrupt();
  CHECK(rig.bus.status().error_passive);
  CHECK(rig.bus.status().error_frames == 2);
}

TEST_CASE("bxCAN: bus-off drops what waits, and the bus is joined again after a growing back-off") {
  Rig rig;
  rig.join();
  std::int64_t now_ms = 0;
  for (const std::int64_t back_off_ms : {100, 200, 400, 800, 1600, 3200, 3200}) {
    CAPTURE(back_off_ms);
    REQUIRE(rig.bus.send(data_frame(0x021)) == SendResult::kQueued);
    rig.can.go_bus_off();
    CHECK(rig.bus.status().bus_off);
    CHECK(rig.bus.send(data_frame(0x022)) == SendResult::kBusOff);
    rig.bus.maintain(now_ms * kMs);
    CHECK(rig.transmit_all().empty());
    for (std::int64_t ms = 1; ms < back_off_ms; ++ms) {
      rig.bus.maintain((now_ms + ms) * kMs);
      rig.can.hear_recovery();
      REQUIRE((rig.can.registers.MCR.stored() & 1) == 0);  // not asked to start over
      REQUIRE(rig.bus.status().bus_off);
    }
    now_ms += back_off_ms;
    rig.bus.maintain(now_ms * kMs);  // asks for initialisation
    CHECK((rig.can.registers.MCR.stored() & 1) == 1);
    rig.bus.maintain(++now_ms * kMs);  // and leaves it
    CHECK((rig.can.registers.MCR.stored() & 1) == 0);
    rig.bus.maintain(++now_ms * kMs);
    CHECK(rig.bus.send(data_frame(0x022)) == SendResult::kBusOff);  // until the wire was idle
    rig.can.hear_recovery();
    rig.bus.maintain(++now_ms * kMs);
    CHECK_FALSE(rig.bus.status().bus_off);
  }
  now_ms += 10'000;
  rig.bus.maintain(now_ms * kMs);
  rig.can.go_bus_off();
  rig.bus.maintain(now_ms * kMs);
  rig.bus.maintain((now_ms + 99) * kMs);
  CHECK((rig.can.registers.MCR.stored() & 1) == 0);
  rig.bus.maintain((now_ms + 100) * kMs);
  CHECK((rig.can.registers.MCR.stored() & 1) == 1);  // ten good seconds: 100 ms again
}

TEST_CASE("bxCAN filters: what is listed, for the controller and the FIFO said, and nothing else") {
  SimulatedBxCan can;
  {
    hal::bxcan::FilterSetup setup(can.registers);
    CHECK(setup.accept(0, 0x001, 0));
    CHECK(setup.accept(0, 0x010, 1));
    CHECK(setup.accept(1, 0x010, 1));
    CHECK(setup.accept(1, 0x7FF, 0));
    CHECK_FALSE(can.filtered(0, standard(0x001)).has_value());  // deaf while it is set up
  }
  for (std::uint32_t id = 0; id < 0x800; ++id) {
    CAPTURE(id);
    const auto first = can.filtered(0, standard(id));
    const auto second = can.filtered(1, standard(id));
    REQUIRE(first.has_value() == (id == 0x001 || id == 0x010));
    REQUIRE(second.has_value() == (id == 0x010 || id == 0x7FF));
    REQUIRE(can.filtered(0, standard(id) | 2) == first);           // remote frames likewise
    REQUIRE_FALSE(can.filtered(0, standard(id) | 4).has_value());  // extended frames never
  }
  CHECK(can.filtered(0, standard(0x001)) == 0);
  CHECK(can.filtered(0, standard(0x010)) == 1);
  CHECK(can.filtered(1, standard(0x7FF)) == 0);
}

TEST_CASE("bxCAN filters: fourteen a controller") {
  SimulatedBxCan can;
  hal::bxcan::FilterSetup setup(can.registers);
  for (std::uint32_t i = 0; i < 14; ++i) CHECK(setup.accept(0, i, 0));
  CHECK_FALSE(setup.accept(0, 14, 0));
  CHECK(setup.accept(1, 14, 0));
}
