// The board by the wall's clock of a machine that is too slow now and then (hoof-emulate): time
// comes to it in steps, at each of which it finds all that has come meanwhile.
#include <catch2/catch.hpp>
#include <deque>
#include <random>

#include "hal/stepped_clock.h"
#include "hil_bridge/service_client.h"
#include "tests/tools/emulator/powered_board.h"

using namespace hoof;
using namespace hoof::tools::emulator;

namespace {

/// As a socket: takes every frame at once, and tells no more than how many.
class Socket final : public hal::CanBus {
 public:
  std::deque<hal::CanFrame>* other = nullptr;
  std::deque<hal::CanFrame> waiting;

  hal::SendResult send(const hal::CanFrame& frame) override {
    if (other != nullptr) other->push_back(frame);
    ++status_.sent;
    return hal::SendResult::kQueued;
  }
  bool receive(hal::CanFrame& frame) override {
    if (waiting.empty()) return false;
    frame = waiting.front();
    waiting.pop_front();
    return true;
  }
  hal::BusStatus status() const override { return status_; }

 private:
  hal::BusStatus status_;
};

}  // namespace

TEST_CASE("a board that comes at odd times, and late, goes on answering") {
  std::mt19937 random(3);
  hal::RamFlash flash = blank_flash();
  hal::SteppedClock wall;
  Socket foot, desk, bus1;
  foot.other = &desk.waiting;
  desk.other = &foot.waiting;
  Board board(test::PoweredBoard::image(), flash);
  board.connect(0, wire_of(foot));
  board.connect(1, wire_of(bus1));
  board.power_on();
  const Cycles start = board.now();
  std::int64_t next_ns = 0;
  // As hoof-emulate: at once where a frame has come, else twice a millisecond, now and then late.
  const auto pass = [&] {
    wall.advance_to(wall.now_ns() + 1 + std::int64_t(random() % 40'000));
    if (wall.now_ns() < next_ns && foot.waiting.empty()) return;
    board.advance_to(start + cycles_of_ns(wall.now_ns()));
    next_ns = wall.now_ns() + 500'000;
    if (random() % 20 == 0) next_ns += std::int64_t(random() % 150) * 1'000'000;
  };
  bridge::ServiceClient client(desk, wall, pass, 2, 5'000'000'000);
  client.connect();
  for (int i = 0; i < 2000; ++i) {
    CAPTURE(i, double(wall.now_ns()) * 1e-9);
    client.wait_until(wall.now_ns() + std::int64_t(random() % 2'500'000));
    REQUIRE_NOTHROW(client.read_parameter(std::uint8_t(i % 60)));
  }
  CHECK(board.resets() == 0);
}

// The heartbeat of a blank part's first start is on its way then. A mailbox that stayed full of it
// would be freed by the one that equals it, 16 later, in whose place that one's stays full: the
// last mailbox then holds a heartbeat for ever, behind which no other may go.
TEST_CASE("a board that is plugged into another wire while it sends keeps its mailboxes") {
  hal::RamFlash flash = blank_flash();
  Board board(test::PoweredBoard::image(), flash);
  board.power_on();
  Socket foot, desk;
  foot.other = &desk.waiting;
  board.connect(0, wire_of(foot));
  const Cycles start = board.now();
  for (int ms = 1; ms <= 5'000; ++ms) board.advance_to(start + ms * kCyclesPerMillisecond);
  CHECK(desk.waiting.size() >= 49);
  CHECK(desk.waiting.size() <= 51);
}
