// Orders to the real control loop over simulated buses; there are no drives.

#include "tools/cli/order.h"

#include <catch2/catch.hpp>

#include "firmware/app/control_loop.h"
#include "firmware/protocol/codec.h"
#include "hal/in_process/in_process_bus.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "tools/run/errors.h"

using namespace hoof;
using firmware::protocol::Order;
using tools::give_order;
using tools::OrderRequest;

namespace {

constexpr std::int64_t kTimeout_ns = 300'000'000;

firmware::app::Parameters without_leg() {
  firmware::app::Parameters parameters;
  parameters.leg_present = 0;
  return parameters;
}

struct Bench {
  hal::InProcessBus bus0{{.name = "can0", .bit_rates = {}}};
  hal::InProcessBus bus1{{.name = "can1", .bit_rates = {}}};
  hal::SteppedClock clock;
  hal::SoftBoard board;
  hal::CanBus& master = bus0.attach("sync");
  hal::CanBus& desk = bus0.attach("supervisor");
  firmware::app::ControlLoop foot{
      {&bus0.attach("foot"), &bus1.attach("foot")}, clock, board, without_leg()};
  std::uint32_t tick = 0;
  bool foot_runs = true;

  void millisecond() {
    master.send(encode(firmware::protocol::Sync{tick++}));
    const std::int64_t end_ns = clock.now_ns() + 1'000'000;
    while (clock.now_ns() < end_ns) {
      clock.advance_to(clock.now_ns() + 100'000);
      bus0.advance_to(clock.now_ns());
      bus1.advance_to(clock.now_ns());
      if (foot_runs) foot.poll();
    }
  }

  std::string order(Order what, std::uint8_t id = 2) {
    OrderRequest request;
    request.order = what;
    request.toe_rad = 0.3;
    request.frequency_Hz = 0.5;
    request.id = id;
    request.timeout_ns = kTimeout_ns;
    return give_order(desk, clock, request, [this] { millisecond(); });
  }

  std::string estop() {
    return tools::press_emergency_stop(desk, clock, kTimeout_ns, [this] { millisecond(); });
  }
};

}  // namespace

TEST_CASE("an order is carried out and the mode told") {
  Bench bench;
  CHECK(bench.order(Order::kReady) == "homing");
  CHECK(bench.order(Order::kStop) == "damped_stop");
}

TEST_CASE("each call is a new supervisor, which learns the counter") {
  Bench bench;
  for (int i = 0; i < 5; ++i) CHECK(bench.order(Order::kStop) == "off");
}

TEST_CASE("a refusal tells order, reason and mode") {
  Bench bench;
  CHECK_THROWS_WITH(bench.order(Order::kRun), "the order 'run' was refused: no_leg (mode off)");
  CHECK_THROWS_AS(bench.order(Order::kRun), tools::CannotFinish);
}

TEST_CASE("a foot that somebody else owns can only be stopped") {
  Bench bench;
  CHECK(bench.order(Order::kReady, 1) == "homing");
  CHECK_THROWS_WITH(bench.order(Order::kReady, 2), Catch::Contains("not_owner (mode homing)"));
  CHECK(bench.order(Order::kStop, 2) == "damped_stop");
}

TEST_CASE("e-stop latches until reset") {
  Bench bench;
  bench.order(Order::kReady);
  CHECK(bench.estop() == "emergency_off");
  CHECK_THROWS_WITH(bench.order(Order::kReady), Catch::Contains("wrong_mode"));
  CHECK(bench.order(Order::kReset) == "off");
}

TEST_CASE("where no foot is, nobody answers") {
  Bench bench;
  bench.foot_runs = false;
  CHECK_THROWS_WITH(bench.order(Order::kStop),
                    "nobody answers: no heartbeat of a foot within 0.3 s; is the firmware running "
                    "on it?");
  CHECK_THROWS_WITH(
      bench.estop(),
      "the e-stop frame was sent, but no foot has told within 0.3 s that it has stopped");
}
