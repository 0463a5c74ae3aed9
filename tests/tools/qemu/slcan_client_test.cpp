// The host's end of a serial line, against an other end that a test plays.
#include "tools/qemu/slcan_client.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <string>
#include <thread>

using namespace hoof;
using tools::qemu::SlcanClient;

namespace {

constexpr std::int64_t kLong_ns = 20'000'000'000, kShort_ns = 200'000'000;

struct Rig {
  int ends[2] = {-1, -1};

  Rig() {
    REQUIRE(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0);
    REQUIRE(fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0);
  }
  ~Rig() {
    close(ends[0]);
    hang_up();
  }
  void hang_up() {
    if (ends[1] >= 0) close(ends[1]);
    ends[1] = -1;
  }
  void say(const std::string& text) const {
    REQUIRE(write(ends[1], text.data(), text.size()) == ssize_t(text.size()));
  }
  std::string hear() const {
    char text[1000];
    const ssize_t n = recv(ends[1], text, sizeof text, MSG_DONTWAIT);
    return {text, n > 0 ? std::size_t(n) : 0};
  }
  /// As the image does; its first answer may be to half a question.
  void open(SlcanClient& client) const {
    say("\aV0100\r\r");
    REQUIRE(client.open(kLong_ns));
    CHECK(hear() == "V\rO\r");
  }
};

hal::CanFrame frame_with(std::uint32_t id, std::uint8_t byte) {
  hal::CanFrame frame;
  frame.id = id;
  frame.length = 1;
  frame.data[0] = byte;
  return frame;
}

}  // namespace

TEST_CASE("slcan client: asks until it is answered, and opens once it is") {
  Rig rig;
  SlcanClient client("USART1", rig.ends[0]);
  CHECK(client.send(frame_with(1, 2)) == hal::SendResult::kDown);
  CHECK_FALSE(client.open(kShort_ns));
  CHECK(rig.hear().substr(0, 4) == "V\rV\r");
  rig.say("\r");  // an end of line alone is no sign of life
  CHECK_FALSE(client.open(kShort_ns));
  rig.say("V01");
  std::thread later([&rig] {
    usleep(100'000);
    rig.say("00\rV0100\r\r");
  });
  CHECK(client.open(kLong_ns));
  later.join();
  CHECK(client.failure().empty());
}

TEST_CASE("slcan client: frames both ways, in pieces too, and how many are not taken") {
  Rig rig;
  SlcanClient client("USART1", rig.ends[0]);
  rig.open(client);
  CHECK(client.send(frame_with(0x123, 0x5A)) == hal::SendResult::kQueued);
  hal::CanFrame extended = frame_with(0x1E5C0001, 7);
  extended.extended = true;
  CHECK(client.send(extended) == hal::SendResult::kQueued);
  CHECK(rig.hear().empty());
  CHECK(client.flush());
  CHECK(rig.hear() == "t12315A\rT1E5C0001107\r");
  CHECK(client.untaken() == 2);
  rig.say("z\rt0811AB\rt0");
  client.wait(kLong_ns);
  CHECK(client.untaken() == 1);
  hal::CanFrame frame;
  REQUIRE(client.receive(frame));
  CHECK(frame == frame_with(0x081, 0xAB));
  CHECK_FALSE(client.receive(frame));
  rig.say("821CD\rZ\r");
  REQUIRE(client.receive(frame));
  CHECK(frame == frame_with(0x082, 0xCD));
  CHECK(client.untaken() == 0);
  CHECK(client.failure().empty());
  hal::CanFrame fd = frame_with(1, 2);
  fd.fd = true;
  CHECK(client.send(fd) == hal::SendResult::kInvalid);
}

TEST_CASE("slcan client: of two lines the second waits until the first one's frames are taken") {
  Rig rig1, rig0;
  SlcanClient client1("USART2", rig1.ends[0]), client0("USART1", rig0.ends[0]);
  rig1.open(client1);
  rig0.open(client0);
  client0.send(frame_with(0x100, 0));
  CHECK(flush_in_order(client1, client0, kLong_ns));  // nothing to wait for
  CHECK(rig0.hear() == "t100100\r");
  client1.send(frame_with(0x201, 1));
  client1.send(frame_with(0x202, 2));
  client0.send(frame_with(0x101, 3));
  CHECK_FALSE(flush_in_order(client1, client0, kShort_ns));
  rig1.say("z\r");
  CHECK_FALSE(flush_in_order(client1, client0, kShort_ns));
  CHECK(rig1.hear() == "t201101\rt202102\r");
  CHECK(rig0.hear().empty());
  rig1.say("z\r");
  CHECK(flush_in_order(client1, client0, kLong_ns));
  CHECK(rig0.hear() == "t101103\r");
  // A line that is dead is waited for no longer; whoever asks the other end will notice.
  client1.send(frame_with(0x203, 4));
  rig1.hang_up();
  CHECK(flush_in_order(client1, client0, kLong_ns));
}

TEST_CASE("slcan client: a refusal, an answer that is none and an end are failures for good") {
  struct Case {
    const char* said;
    const char* failure;
  };
  for (const Case& c : {Case{"\a", "USART2: the other end refused a line"},
                        Case{"t12\r", "USART2: 't12' is no answer"}}) {
    Rig rig;
    SlcanClient client("USART2", rig.ends[0]);
    rig.open(client);
    rig.say(c.said);
    client.wait(kLong_ns);
    CHECK(client.failure() == c.failure);
  }
  Rig rig;
  SlcanClient client("USART2", rig.ends[0]);
  rig.open(client);
  rig.hang_up();
  client.wait(kLong_ns);
  CHECK(client.failure() == "USART2 was closed");
  CHECK(client.send(frame_with(1, 2)) == hal::SendResult::kQueued);
  CHECK_FALSE(client.flush());
  CHECK_FALSE(client.open(kShort_ns));
}
