#include "firmware/app/order_desk.h"

#include <catch2/catch.hpp>

using namespace hoof::firmware;
using app::OrderDesk;
using control::Mode;
using protocol::Order;
using protocol::OrderResult;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

struct Office {
  control::FootController controller{{}, {}};
  safety::TorqueGate gate{control::JointPresence{}};
  OrderDesk desk{controller, gate};
  std::uint8_t counter = 0;

  protocol::OrderAcknowledge ask(Order order, std::uint8_t who, std::int64_t now_ns,
                                 float toe_rad = 0.1f, float frequency_Hz = 1.0f) {
    const auto answer = desk.handle(
        {protocol::DecodeResult::kOk, {who, order, toe_rad, frequency_Hz, counter}}, now_ns);
    counter = answer.expected_counter;
    return answer;
  }
};

}  // namespace

TEST_CASE("The first to be accepted owns the foot; release hands it over") {
  Office office;
  CHECK(office.ask(Order::kReady, 5, 0, 9.0f).result == OrderResult::kOutOfRange);
  CHECK(office.desk.owner_id() == 0);
  const auto answer = office.ask(Order::kReady, 5, 0);
  CHECK(answer.result == OrderResult::kAccepted);
  CHECK(answer.owner_id == 5);
  CHECK(answer.mode == protocol::Mode::kHoming);
  CHECK(office.ask(Order::kReady, 6, 1).result == OrderResult::kNotOwner);
  CHECK(office.ask(Order::kRelease, 6, 1).result == OrderResult::kNotOwner);
  CHECK(office.ask(Order::kRelease, 5, 1).result == OrderResult::kAccepted);
  CHECK(office.ask(Order::kReady, 6, 2).owner_id == 6);
}

TEST_CASE("An owner keeps a moving foot, however silent; an idle one for a second") {
  Office office;
  office.ask(Order::kReady, 5, 0);
  CHECK(office.ask(Order::kReady, 6, 100 * kSecond_ns).result == OrderResult::kNotOwner);
  office.controller.emergency_stop();
  CHECK(office.ask(Order::kReset, 6, kSecond_ns).result == OrderResult::kNotOwner);
  CHECK(office.ask(Order::kReset, 6, kSecond_ns + 1).result == OrderResult::kAccepted);
  CHECK(office.desk.owner_id() == 6);
}

TEST_CASE("A stop by somebody else is obeyed and leaves the owner the owner") {
  Office office;
  office.ask(Order::kReady, 5, 0);
  CHECK(office.ask(Order::kStop, 9, 1).result == OrderResult::kAccepted);
  CHECK(office.controller.mode() == Mode::kDampedStop);
  CHECK(office.desk.owner_id() == 5);
}

TEST_CASE("The counter must be the expected one; it goes on with every order that was judged") {
  Office office;
  CHECK(office.ask(Order::kReady, 5, 0).expected_counter == 1);
  CHECK(office.ask(Order::kReady, 5, 0, 9.0f).expected_counter == 2);  // out of range: judged
  office.counter = 1;
  const auto answer = office.ask(Order::kStop, 5, 0);
  CHECK(answer.result == OrderResult::kBadCounter);
  CHECK(answer.expected_counter == 2);
  for (int i = 0; i < 600; ++i) {  // more than twice round the byte
    REQUIRE(office.ask(Order::kReady, 5, 0).result == OrderResult::kAccepted);
  }
}

TEST_CASE("Unknown orders and nobody's orders are refused") {
  Office office;
  CHECK(office.ask(static_cast<Order>(77), 5, 0).result == OrderResult::kUnknownOrder);
  CHECK(office.ask(Order::kReady, 0, 0).result == OrderResult::kNotOwner);
  CHECK(office.ask(Order::kStop, 0, 0).result == OrderResult::kNotOwner);
  CHECK(office.controller.mode() == Mode::kOff);
}

TEST_CASE("A reset lifts the gate's latch only where the controller allows it") {
  Office office;
  office.gate.latch();
  office.ask(Order::kReady, 5, 0);
  CHECK(office.ask(Order::kReset, 5, 0).result == OrderResult::kWrongMode);
  CHECK(office.gate.latched());
  office.controller.emergency_stop();
  CHECK(office.ask(Order::kReset, 5, 0).result == OrderResult::kAccepted);
  CHECK_FALSE(office.gate.latched());
}
