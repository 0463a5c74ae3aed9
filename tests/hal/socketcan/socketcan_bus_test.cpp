// Needs vcan0 (CTest label `can`); tests/hal/socketcan/run_where_vcan_is.sh finds or makes one.
#include "hal/socketcan/socketcan_bus.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <random>
#include <stdexcept>

#include "hal/can_frame_check.h"
#include "hal/monotonic_clock.h"
#include "tests/hal/wire_reference.h"

namespace hoof::hal {
namespace {

constexpr std::int64_t kPatience_ns =
    2'000'000'000;  // emulated machines are slow; only a failure waits

CanFrame frame(std::uint32_t id, std::vector<std::uint8_t> data = {}) {
  CanFrame out;
  out.id = id;
  out.length = static_cast<std::uint8_t>(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) out.data[i] = data[i];
  return out;
}

SocketCanSettings vcan(bool fd = false) {
  SocketCanSettings settings;
  settings.interface = "vcan0";
  settings.fd = fd;
  return settings;
}

bool receive_soon(SocketCanBus& bus, CanFrame& got) {
  const MonotonicClock clock;
  const std::int64_t deadline_ns = clock.now_ns() + kPatience_ns;
  while (clock.now_ns() < deadline_ns) {
    if (bus.receive(got)) return true;
    bus.wait(deadline_ns - clock.now_ns());
  }
  return false;
}

/// A socket that can inject what a driver would report: error frames.
class RawSocket {
 public:
  RawSocket() : fd_(socket(PF_CAN, SOCK_RAW, CAN_RAW)) {
    ifreq request{};
    std::strcpy(request.ifr_name, "vcan0");
    REQUIRE(ioctl(fd_, SIOCGIFINDEX, &request) == 0);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = request.ifr_ifindex;
    REQUIRE(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~RawSocket() { close(fd_); }
  void send_error(std::uint32_t error_class, std::vector<std::uint8_t> data) const {
    can_frame raw{};
    raw.can_id = CAN_ERR_FLAG | error_class;
    raw.can_dlc = CAN_ERR_DLC;
    std::copy(data.begin(), data.end(), raw.data);
    REQUIRE(write(fd_, &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw));
  }

 private:
  int fd_;
};

}  // namespace

TEST_CASE("classic frames of every kind arrive as sent, at the others only", "[socketcan]") {
  SocketCanBus a(vcan());
  SocketCanBus b(vcan());
  const unsigned seed = 5;
  INFO("seed " << seed);
  std::mt19937 random(seed);
  for (int i = 0; i < 500; ++i) {
    const CanFrame sent = test::random_classic_frame(random);
    REQUIRE(a.send(sent) == SendResult::kQueued);
    CanFrame got;
    REQUIRE(receive_soon(b, got));
    INFO(test::describe(sent));
    REQUIRE(got == sent);
  }
  CanFrame got = frame(0x7A5);
  CHECK_FALSE(a.receive(got));
  CHECK(got == frame(0x7A5));
  CHECK(a.status().sent == 500);
  CHECK(b.status().received == 500);
  CHECK(b.status().dropped == 0);
}

TEST_CASE("FD frames pass between FD sockets and are refused by classic ones", "[socketcan]") {
  SocketCanBus a(vcan(true));
  SocketCanBus b(vcan(true));
  SocketCanBus classic(vcan());
  CanFrame sent = frame(0x123, std::vector<std::uint8_t>(48, 0x5A));
  sent.fd = true;
  sent.bit_rate_switch = true;
  CHECK(classic.send(sent) == SendResult::kInvalid);
  REQUIRE(a.send(sent) == SendResult::kQueued);
  REQUIRE(a.send(frame(0x124, {1})) == SendResult::kQueued);
  CanFrame got;
  REQUIRE(receive_soon(b, got));
  CHECK(got == sent);
  REQUIRE(receive_soon(b, got));
  CHECK(got == frame(0x124, {1}));
  // The classic node hears the classic frame and is not disturbed by the other.
  REQUIRE(receive_soon(classic, got));
  CHECK(got == frame(0x124, {1}));
  sent.length = 9;
  CHECK(a.send(sent) == SendResult::kInvalid);
}

TEST_CASE("stamps are on the monotonic clock, between sending and reading", "[socketcan]") {
  const MonotonicClock clock;
  SocketCanBus a(vcan());
  SocketCanBus b(vcan());
  // The kernel's stamp and the two clock reads that convert it are not one instant.
  constexpr std::int64_t kConversion_ns = 1'000'000;
  const std::int64_t before_ns = clock.now_ns();
  REQUIRE(a.send(frame(0x10)) == SendResult::kQueued);
  const std::int64_t sent_ns = clock.now_ns();
  // Read late: the stamp must tell the arrival, not the reading.
  usleep(50'000);
  CanFrame got;
  REQUIRE(receive_soon(b, got));
  CHECK(got.stamp_ns >= before_ns - kConversion_ns);
  CHECK(got.stamp_ns <= sent_ns + kConversion_ns);
}

TEST_CASE("filters keep out other identifiers and the other format", "[socketcan]") {
  SocketCanBus a(vcan());
  SocketCanSettings settings = vcan();
  settings.filters = {{0x120, 0x7F0, false}, {0x12345678, 0x1FFF'FFFF, true}};
  SocketCanBus b(settings);
  for (const bool extended : {false, true}) {
    for (const std::uint32_t id : {0x11FU, 0x120U, 0x12FU, 0x130U, 0x12345678U, 0x12345679U}) {
      CanFrame sent = frame(id);
      sent.extended = extended;
      if (can_exist(sent)) REQUIRE(a.send(sent) == SendResult::kQueued);
    }
  }
  CanFrame got;
  REQUIRE(receive_soon(b, got));
  CHECK((got.id == 0x120 && !got.extended));
  REQUIRE(receive_soon(b, got));
  CHECK((got.id == 0x12F && !got.extended));
  REQUIRE(receive_soon(b, got));
  CHECK((got.id == 0x12345678 && got.extended));
  CHECK_FALSE(b.receive(got));
}

TEST_CASE("what cannot exist is refused before the kernel sees it", "[socketcan]") {
  SocketCanBus bus(vcan());
  CHECK(bus.send(frame(0x800)) == SendResult::kInvalid);
  CanFrame too_long = frame(1);
  too_long.length = 9;
  CHECK(bus.send(too_long) == SendResult::kInvalid);
  CHECK(bus.status().sent == 0);
}

TEST_CASE("error frames become status: passive, counters, bus-off, restart", "[socketcan]") {
  SocketCanBus bus(vcan());
  const RawSocket driver;
  CanFrame got;
  driver.send_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE, 0, 0, 0, 0, 136, 12});
  REQUIRE(bus.wait(kPatience_ns));
  CHECK_FALSE(bus.receive(got));
  CHECK(bus.status().error_passive);
  CHECK(bus.status().transmit_error_count == 136);
  CHECK(bus.status().receive_error_count == 12);
  CHECK(bus.status().error_frames == 1);
  CHECK(bus.status().received == 0);
  CHECK(bus.send(frame(1)) == SendResult::kQueued);

  driver.send_error(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING, 0, 0, 0, 0, 100, 12});
  CHECK_FALSE(bus.receive(got));
  CHECK_FALSE(bus.status().error_passive);

  driver.send_error(CAN_ERR_BUSOFF, {});
  CHECK_FALSE(bus.receive(got));
  CHECK(bus.status().bus_off);
  CHECK(bus.send(frame(1)) == SendResult::kBusOff);

  driver.send_error(CAN_ERR_RESTARTED, {});
  CHECK_FALSE(bus.receive(got));
  CHECK_FALSE(bus.status().bus_off);
  CHECK(bus.send(frame(1)) == SendResult::kQueued);
  CHECK(bus.status().error_frames == 4);
}

TEST_CASE("a sleeping reader loses frames, and every loss is counted", "[socketcan]") {
  SocketCanBus sender(vcan());
  SocketCanSettings settings = vcan();
  settings.receive_buffer_bytes = 16 * 1024;
  SocketCanBus sleeper(settings);
  constexpr int kFrames = 2'000;
  for (int i = 0; i < kFrames; ++i) REQUIRE(sender.send(frame(0x55)) == SendResult::kQueued);
  std::uint64_t got_count = 0;
  CanFrame got;
  while (sleeper.receive(got)) ++got_count;
  CHECK(got_count < kFrames);
  // The count of losses travels with the next frame that is let in.
  REQUIRE(sender.send(frame(0x56)) == SendResult::kQueued);
  REQUIRE(receive_soon(sleeper, got));
  CHECK(got.id == 0x56);
  CHECK(sleeper.status().dropped == kFrames - got_count);
}

TEST_CASE("the default buffer holds a second of a fully loaded bus half asleep", "[socketcan]") {
  SocketCanBus sender(vcan());
  SocketCanBus sleeper(vcan());
  CHECK(sleeper.receive_buffer_bytes() >= 4 * 1024 * 1024);  // the tests run as root
  constexpr int kFrames = 4'000;
  for (int i = 0; i < kFrames; ++i) REQUIRE(sender.send(frame(0x55)) == SendResult::kQueued);
  CanFrame got;
  int got_count = 0;
  while (sleeper.receive(got)) ++got_count;
  CHECK(got_count == kFrames);
  CHECK(sleeper.status().dropped == 0);
}

TEST_CASE("a batched bus keeps frames until it is told, and loses no order", "[socketcan]") {
  SocketCanSettings batched = vcan();
  batched.batched = true;
  SocketCanBus a(batched), b(batched), plain(vcan());
  CanFrame got;
  for (std::uint32_t id : {1u, 2u, 3u}) CHECK(a.send(frame(id, {9})) == SendResult::kQueued);
  CHECK_FALSE(plain.wait(20'000'000));
  CHECK(a.flush() == SendResult::kQueued);
  // Both kinds of wait: the socket's own coarse time-out, and the fine one of poll().
  const std::int64_t timeout_ns = GENERATE(kPatience_ns, std::int64_t{5'000'000});
  REQUIRE(b.wait(timeout_ns));
  for (std::uint32_t id : {1u, 2u, 3u}) {
    REQUIRE(b.receive(got));
    CHECK(got == frame(id, {9}));
    CHECK(got.stamp_ns == 0);
  }
  CHECK_FALSE(b.receive(got));
  CHECK_FALSE(b.receive(got));
  CHECK_FALSE(b.wait(25'000'000));

  // wait() gives up what was kept, as an answer to it is what is waited for.
  a.send(frame(4));
  CHECK_FALSE(a.wait(1'000'000));
  REQUIRE(b.wait(timeout_ns));
  REQUIRE(b.receive(got));
  CHECK(got.id == 4);

  // More than a batch, either way.
  constexpr std::uint32_t kMany = 100;
  for (std::uint32_t id = 0; id < kMany; ++id) {
    REQUIRE(a.send(frame(id)) == SendResult::kQueued);
  }
  a.flush();
  std::uint32_t next = 0;
  while (next < kMany && b.wait(timeout_ns)) {
    while (b.receive(got)) CHECK(got.id == next++);
  }
  CHECK(next == kMany);
  CHECK(b.status().received == 4 + kMany);
  CHECK(b.status().dropped == 0);
}

TEST_CASE("a batched bus counts losses as a plain one", "[socketcan]") {
  SocketCanSettings settings = vcan();
  settings.batched = true;
  SocketCanBus sender(settings);
  settings.receive_buffer_bytes = 16 * 1024;
  SocketCanBus sleeper(settings);
  constexpr std::uint64_t kFrames = 2'000;
  for (std::uint64_t i = 0; i < kFrames; ++i) sender.send(frame(0x55));
  sender.flush();
  std::uint64_t count = 0;
  CanFrame got;
  while (sleeper.wait(0)) {
    while (sleeper.receive(got)) ++count;
  }
  CHECK(count < kFrames);
  sender.send(frame(0x56));
  sender.flush();
  REQUIRE(sleeper.wait(kPatience_ns));
  while (sleeper.receive(got)) ++count;
  CHECK(got.id == 0x56);
  CHECK(sleeper.status().dropped == kFrames + 1 - count);
}

TEST_CASE("waiting ends with a frame or with the time", "[socketcan]") {
  const MonotonicClock clock;
  SocketCanBus a(vcan());
  SocketCanBus b(vcan());
  const std::int64_t before_ns = clock.now_ns();
  CHECK_FALSE(b.wait(30'000'000));
  CHECK(clock.now_ns() - before_ns >= 30'000'000);
  CHECK_FALSE(b.wait(0));
  a.send(frame(1));
  CHECK(b.wait(kPatience_ns));
}

TEST_CASE("what is wrong with an interface is said by name, with the cure", "[socketcan]") {
  SocketCanSettings settings;
  settings.interface = "nocan7";
  CHECK_THROWS_WITH(
      SocketCanBus(settings),
      Catch::Contains("nocan7") && Catch::Contains("ip link add dev nocan7 type vcan"));
  settings.interface = "";
  CHECK_THROWS_AS(SocketCanBus(settings), std::runtime_error);
  settings.interface = "an-interface-name-too-long";
  CHECK_THROWS_AS(SocketCanBus(settings), std::runtime_error);
  settings.interface = "lo";  // exists, is up, is no CAN
  CHECK_THROWS_WITH(SocketCanBus(settings), Catch::Contains("lo: this is no CAN interface"));
}

}  // namespace hoof::hal
