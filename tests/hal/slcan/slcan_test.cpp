// Lines against the protocol's own examples, both ways for random frames, and what is no line.
#include <catch2/catch.hpp>
#include <deque>
#include <random>
#include <string>
#include <string_view>

#include "hal/slcan/fallback_bus.h"
#include "hal/slcan/line.h"
#include "hal/slcan/slcan_bus.h"

using namespace hoof::hal;

namespace {

std::string text_of(std::span<const std::uint8_t> bytes) {
  return {bytes.begin(), bytes.end()};
}

bool read(std::string_view text, CanFrame& frame) {
  const std::string copy(text);
  return slcan::frame_of({reinterpret_cast<const std::uint8_t*>(copy.data()), copy.size()}, frame);
}

CanFrame standard(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  CanFrame frame;
  frame.id = id;
  for (const std::uint8_t byte : data) frame.data[frame.length++] = byte;
  return frame;
}

CanFrame random_frame(std::mt19937_64& random) {
  CanFrame frame;
  frame.extended = random() % 2 == 0;
  frame.remote = random() % 4 == 0;
  frame.id = static_cast<std::uint32_t>(random()) & (frame.extended ? 0x1FFF'FFFF : 0x7FF);
  frame.length = static_cast<std::uint8_t>(random() % 9);
  for (std::size_t i = 0; i < frame.length && !frame.remote; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(random());
  }
  return frame;
}

class FakePort {
 public:
  std::string sent;
  std::size_t space = 1000;

  bool write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > room()) return false;
    sent += text_of(bytes);
    return true;
  }
  std::size_t room() const { return space - sent.size(); }
};

struct Adapter {
  FakePort port;
  slcan::SlcanBus<FakePort> bus{port};

  std::string say(std::string_view text, std::int64_t now_ns = 0) {
    port.sent.clear();
    for (const char c : text) bus.on_byte(static_cast<std::uint8_t>(c), now_ns);
    return port.sent;
  }
};

class FakeCan final : public CanBus {
 public:
  std::deque<CanFrame> coming;
  std::vector<CanFrame> sent;
  int withdrawn = 0;

  SendResult send(const CanFrame& frame) override {
    sent.push_back(frame);
    return SendResult::kQueued;
  }
  void withdraw(std::uint32_t) override { ++withdrawn; }
  bool receive(CanFrame& frame) override {
    if (coming.empty()) return false;
    frame = coming.front();
    coming.pop_front();
    return true;
  }
  BusStatus status() const override {
    BusStatus status;
    status.sent = sent.size();
    return status;
  }
};

}  // namespace

TEST_CASE("slcan line: the examples of the protocol's manual") {
  // CAN232 manual: t10021133, t1000 and T00000100 with lengths; r1002.
  CHECK(text_of(slcan::line_of(standard(0x100, {0x11, 0x33})).bytes()) == "t10021133\r");
  CHECK(text_of(slcan::line_of(standard(0x020, {})).bytes()) == "t0200\r");
  CanFrame extended = standard(0x100, {0x11, 0x33});
  extended.extended = true;
  CHECK(text_of(slcan::line_of(extended).bytes()) == "T0000010021133\r");
  CanFrame remote = standard(0x100, {});
  remote.remote = true;
  remote.length = 2;
  CHECK(text_of(slcan::line_of(remote).bytes()) == "r1002\r");
  CanFrame frame;
  REQUIRE(read("t10021133", frame));
  CHECK(frame == standard(0x100, {0x11, 0x33}));
  REQUIRE(read("r1002", frame));
  CHECK(frame == remote);
}

TEST_CASE("slcan line: any frame comes back as it went") {
  const std::uint64_t seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 20'000; ++i) {
    const CanFrame frame = random_frame(random);
    const slcan::Line line = slcan::line_of(frame);
    REQUIRE(line.length > 0);
    REQUIRE(line.length <= slcan::kLongestLine);
    REQUIRE(line.text[line.length - 1] == slcan::kEnd);
    CanFrame back;
    REQUIRE(slcan::frame_of(line.bytes().first(line.length - 1), back));
    REQUIRE(back == frame);
  }
}

TEST_CASE("slcan line: what is no frame is refused, and changes nothing") {
  const CanFrame before = standard(0x123, {7});
  for (const char* text : {"",
                           "t",
                           "t12",
                           "t123",
                           "t1239",
                           "t8000",
                           "t7FF9112233445566778899",
                           "t1231",
                           "t12311",
                           "t1231112",
                           "t12g0",
                           "t1230 ",
                           "tt230",
                           "T1234567",
                           "T200000000",
                           "T0000010021133x",
                           "r1231AA",
                           "x1230",
                           "t123A",
                           "t-120",
                           "z",
                           "O"}) {
    CAPTURE(text);
    CanFrame frame = before;
    CHECK_FALSE(read(text, frame));
    CHECK(frame == before);
  }
  CanFrame fd = standard(0x100, {1});
  fd.fd = true;
  CHECK(slcan::line_of(fd).length == 0);
  CanFrame wide = standard(0x800, {});
  CHECK(slcan::line_of(wide).length == 0);
}

TEST_CASE("slcan bus: what the other side's driver says before its first frame is answered") {
  Adapter adapter;
  CHECK(adapter.say("\r\r\r") == "\r\r\r");  // slcand clears the line so
  CHECK(adapter.say("C\r") == "\r");
  CHECK(adapter.say("S8\r") == "\r");
  CHECK(adapter.say("Z0\r") == "\r");
  CHECK(adapter.say("Z1\r") == "\a");
  CHECK(adapter.say("V\r") == "V0100\r");
  CHECK(adapter.say("N\r") == "NHOOF\r");
  CHECK(adapter.say("t1230\r") == "\a");  // not open yet
  CHECK_FALSE(adapter.bus.open());
  CHECK(adapter.bus.send(standard(1, {})) == SendResult::kDown);
  CHECK(adapter.say("O\r") == "\r");
  CHECK(adapter.bus.open());
  CHECK(adapter.say("hello\r") == "\a");
  CHECK(adapter.say("OO\r") == "\a");
  CHECK(adapter.say("C\n\r") == "\r");
  CHECK_FALSE(adapter.bus.open());
}

TEST_CASE("slcan bus: frames both ways, stamped, counted, in order") {
  Adapter adapter;
  adapter.say("O\r");
  CHECK(adapter.say("t12321122\r", 5) == "z\r");
  CHECK(adapter.say("T000001000\r", 6) == "Z\r");
  CHECK(adapter.bus.frame_waiting());
  CanFrame frame;
  REQUIRE(adapter.bus.receive(frame));
  CHECK(frame == standard(0x123, {0x11, 0x22}));
  CHECK(frame.stamp_ns == 5);
  REQUIRE(adapter.bus.receive(frame));
  CHECK(frame.extended);
  CHECK(frame.id == 0x100);
  CHECK(frame.stamp_ns == 6);
  CHECK_FALSE(adapter.bus.receive(frame));
  adapter.port.sent.clear();
  CHECK(adapter.bus.send(standard(0x7FF, {0xAB})) == SendResult::kQueued);
  CHECK(adapter.port.sent == "t7FF1AB\r");
  CanFrame fd = standard(1, {});
  fd.fd = true;
  CHECK(adapter.bus.send(fd) == SendResult::kInvalid);
  CHECK(adapter.bus.status().sent == 1);
  CHECK(adapter.bus.status().received == 2);
}

TEST_CASE("slcan bus: a full queue drops and tells, a full line takes nothing") {
  Adapter adapter;
  adapter.say("O\r");
  for (std::uint32_t i = 0; i < slcan::SlcanBus<FakePort>::kQueue; ++i)
    CHECK(adapter.say("t0010\r") == "z\r");
  CHECK(adapter.say("t0010\r") == "\a");
  CHECK(adapter.bus.status().dropped == 1);
  CanFrame frame;
  REQUIRE(adapter.bus.receive(frame));
  CHECK(adapter.say("t0010\r") == "z\r");
  adapter.port.sent.clear();
  adapter.port.space = 7;
  CHECK(adapter.bus.send(standard(0x100, {1, 2})) == SendResult::kFull);
  CHECK(adapter.port.sent.empty());
  CHECK(adapter.bus.status().free == 0);
  CHECK(adapter.bus.send(standard(0x100, {})) == SendResult::kQueued);
}

TEST_CASE("slcan bus: a line that is too long, or lost a byte, is no line; the next one is") {
  Adapter adapter;
  adapter.say("O\r");
  CHECK(adapter.say("T0000010081122334455667788" + std::string(30, '0') + "\r") == "\a");
  CHECK(adapter.say("t1230\r") == "z\r");
  adapter.say("t12");
  adapter.bus.on_lost_byte();
  CHECK(adapter.say("0\r") == "\a");
  CHECK(adapter.say("T0000010081122334455667788\r") == "Z\r");
  CanFrame frame;
  CHECK(adapter.bus.receive(frame));
  CHECK(adapter.bus.receive(frame));
  CHECK_FALSE(adapter.bus.receive(frame));
}

TEST_CASE("slcan bus: rubbish of any kind makes no frame that cannot exist") {
  const std::uint64_t seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  Adapter adapter;
  adapter.port.space = 1'000'000;
  int frames = 0, refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    adapter.say("O\r");
    // A frame's line, now and then with a character changed, lost or put in.
    std::string text = text_of(slcan::line_of(random_frame(random)).bytes());
    for (std::uint64_t n = random() % 3; n > 0; --n) {
      const std::size_t at = random() % text.size();
      const char c =
          random() % 4 == 0 ? static_cast<char>(random()) : "tTrR0fF9\r\n"[random() % 10];
      if (random() % 3 == 0) text[at] = c;
      if (random() % 3 == 0) text.insert(at, 1, c);
      if (random() % 3 == 0 && text.size() > 1) text.erase(at, 1);
    }
    adapter.say(text);
    CanFrame frame;
    bool any = false;
    while (adapter.bus.receive(frame)) {
      any = true;
      REQUIRE(frame.id <= (frame.extended ? 0x1FFF'FFFFu : 0x7FFu));
      REQUIRE(frame.length <= 8);
    }
    ++(any ? frames : refused);
    adapter.say("\r");
  }
  CHECK(frames > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("fallback bus: serial until CAN speaks, then never again before a reset") {
  FakeCan can;
  Adapter adapter;
  SerialGate gate;
  FallbackBus<FakeCan, slcan::SlcanBus<FakePort>> bus(can, adapter.bus, gate);
  CanFrame frame;
  // Nobody opened it: CAN as ever.
  CHECK(bus.send(standard(1, {})) == SendResult::kQueued);
  CHECK(can.sent.size() == 1);
  adapter.say("O\r");
  adapter.say("t0110\r");
  REQUIRE(bus.receive(frame));
  CHECK(frame.id == 0x011);
  adapter.port.sent.clear();
  CHECK(bus.send(standard(2, {})) == SendResult::kQueued);
  CHECK(can.sent.size() == 1);
  CHECK(adapter.port.sent == "t0020\r");
  bus.withdraw(2);
  CHECK(can.withdrawn == 0);
  // What waits on the line when CAN speaks is not read any more.
  adapter.say("t0120\r");
  can.coming.push_back(standard(0x100, {}));
  REQUIRE(bus.receive(frame));
  CHECK(frame.id == 0x100);
  CHECK_FALSE(bus.receive(frame));
  CHECK(adapter.say("O\r") == "\a");
  CHECK(bus.send(standard(3, {})) == SendResult::kQueued);
  CHECK(can.sent.size() == 2);
  CHECK(bus.status().sent == 2);
}

TEST_CASE("fallback bus: CAN on one of two buses shuts the lines of both") {
  FakeCan can0, can1;
  Adapter serial0, serial1;
  SerialGate gate;
  FallbackBus<FakeCan, slcan::SlcanBus<FakePort>> bus0(can0, serial0.bus, gate),
      bus1(can1, serial1.bus, gate);
  serial1.say("O\r");
  serial1.say("t0110\r");
  can0.coming.push_back(standard(0x100, {}));
  CanFrame frame;
  REQUIRE(bus0.receive(frame));
  CHECK_FALSE(bus1.receive(frame));
  CHECK(bus1.send(standard(3, {})) == SendResult::kQueued);
  CHECK(can1.sent.size() == 1);
}
