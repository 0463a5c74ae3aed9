#include "firmware/app/order_desk.h"

#include <catch2/catch.hpp>

#include "firmware/protocol/protocol_hash.h"

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
  app::Ownership ownership;
  OrderDesk desk{controller, gate, ownership};
  bool synced = true;
  std::uint8_t counter = 0;

  protocol::OrderAcknowledge ask(Order order, std::uint8_t who, std::int64_t now_ns,
                                 float toe_rad = 0.1f, float frequency_Hz = 1.0f) {
    desk.handle(protocol::SupervisorConnect{who, protocol::kProtocolHash}, now_ns);
    const auto answer =
        desk.handle({protocol::DecodeResult::kOk, {who, order, toe_rad, frequency_Hz, counter}},
                    synced, now_ns);
    counter = answer.expected_counter;
    return answer;
  }
};

}  // namespace

TEST_CASE("The first to be accepted owns the foot; release hands it over") {
  Office office;
  CHECK(office.ask(Order::kReady, 5, 0, 9.0f).result == OrderResult::kOutOfRange);
  CHECK(office.ownership.owner_id() == 0);
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
  CHECK(office.ownership.owner_id() == 6);
}

TEST_CASE("A stop by somebody else is obeyed and leaves the owner the owner") {
  Office office;
  office.ask(Order::kReady, 5, 0);
  CHECK(office.ask(Order::kStop, 9, 1).result == OrderResult::kAccepted);
  CHECK(office.controller.mode() == Mode::kDampedStop);
  CHECK(office.ownership.owner_id() == 5);
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
  CHECK(office.ask(Order::kReady, 0, 0).result == OrderResult::kNotConnected);
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

TEST_CASE("Without SYNC nothing is begun, with the button pressed nothing is reset") {
  Office office;
  office.synced = false;
  CHECK(office.ask(Order::kReady, 5, 0).result == OrderResult::kNoSync);
  CHECK(office.ask(Order::kRun, 5, 0).result == OrderResult::kNoSync);
  CHECK(office.controller.mode() == Mode::kOff);
  CHECK(office.ask(Order::kStop, 5, 0).result == OrderResult::kAccepted);
  office.synced = true;
  office.controller.emergency_stop();
  office.gate.emergency_line(true);
  CHECK(office.ask(Order::kReset, 5, 0).result == OrderResult::kWrongMode);
  CHECK(office.controller.mode() == Mode::kEmergencyOff);
  office.gate.emergency_line(false);
  CHECK(office.ask(Order::kReset, 5, 0).result == OrderResult::kAccepted);
}

TEST_CASE("A supervisor with another dictionary is refused, and so are its orders; it may stop") {
  Office office;
  const auto connect = [&](std::uint8_t who, std::uint32_t hash, std::int64_t now_ns) {
    return office.desk.handle(protocol::SupervisorConnect{who, hash, 42}, now_ns);
  };
  const auto order = [&](std::uint8_t who, Order what, std::int64_t now_ns) {
    return office.desk
        .handle({protocol::DecodeResult::kOk,
                 {who, what, 0.1f, 1.0f, office.ownership.expected_counter()}},
                true, now_ns)
        .result;
  };
  const auto refused = connect(5, protocol::kProtocolHash ^ 1u, 0);
  CHECK(refused.result == OrderResult::kOtherDictionary);
  CHECK(refused.counter == 42);
  CHECK(refused.supervisor_id == 5);
  CHECK(order(5, Order::kReady, 0) == OrderResult::kNotConnected);
  CHECK(order(5, Order::kStop, 0) == OrderResult::kAccepted);
  CHECK(office.ownership.owner_id() == 0);  // not for that
  CHECK(connect(5, protocol::kProtocolHash, 0).result == OrderResult::kAccepted);
  CHECK(order(5, Order::kReady, 0) == OrderResult::kAccepted);
  // The same number comes back with another program.
  CHECK(connect(5, 0, 1).result == OrderResult::kOtherDictionary);
  CHECK(order(5, Order::kRun, 2) == OrderResult::kNotConnected);
}

TEST_CASE("A connection lapses after a second of silence; every word renews it") {
  Office office;
  app::Ownership& ownership = office.ownership;
  REQUIRE(ownership.connect(5, protocol::kProtocolHash, 0));
  CHECK(ownership.connected(5, kSecond_ns));
  CHECK_FALSE(ownership.connected(5, kSecond_ns + 1));
  ownership.hear(5, kSecond_ns);
  CHECK(ownership.connected(5, 2 * kSecond_ns));
  ownership.hear(5, 4 * kSecond_ns);  // too late: it must connect anew
  CHECK_FALSE(ownership.connected(5, 4 * kSecond_ns));
  CHECK_FALSE(ownership.connected(6, 0));
}

TEST_CASE("The fifth supervisor takes the place of the one silent for longest, never the owner's") {
  app::Ownership ownership;
  for (std::uint8_t id = 1; id <= 4; ++id) {
    REQUIRE(ownership.connect(id, protocol::kProtocolHash, id));
  }
  ownership.own(1, 1);
  REQUIRE(ownership.connect(9, protocol::kProtocolHash, 10));
  CHECK(ownership.connected(1, 10));
  CHECK_FALSE(ownership.connected(2, 10));
  CHECK(ownership.connected(9, 10));
  // Once somebody has lapsed, that place goes first.
  ownership.hear(1, kSecond_ns);
  ownership.hear(4, kSecond_ns);
  REQUIRE(ownership.connect(8, protocol::kProtocolHash, kSecond_ns + 4));
  CHECK(ownership.connected(4, kSecond_ns + 4));
  CHECK_FALSE(ownership.connected(3, kSecond_ns + 4));
}
