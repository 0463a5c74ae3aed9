#include "hil_bridge/supervisor.h"

#include <catch2/catch.hpp>
#include <vector>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/protocol_hash.h"
#include "hal/in_process/in_process_bus.h"

using namespace hoof;
using namespace firmware::protocol;
using bridge::Supervisor;

namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::uint8_t kId = 7;

/// A supervisor on a bus with a foot that says what the test wants.
struct Bench {
  hal::InProcessBus bus{{.name = "bus", .bit_rates = {}}};
  hal::InProcessPort& foot = bus.attach("foot");
  Supervisor supervisor{bus.attach("supervisor"), kId};
  std::vector<SupervisorConnect> connects;
  bool welcomes = true;       // connections are answered at once
  std::uint8_t expected = 0;  // counter told in that answer

  void answer_connect(const SupervisorConnect& connect, OrderResult result) {
    OrderAcknowledge answer;
    answer.supervisor_id = connect.supervisor_id;
    answer.counter = connect.counter;
    answer.result = result;
    answer.expected_counter = expected;
    foot.send(encode(answer));
  }

  /// Lets `ms` milliseconds pass; the orders that arrived at the foot.
  std::vector<SupervisorOrder> run(int ms) {
    std::vector<SupervisorOrder> orders;
    for (int i = 0; i < ms; ++i) {
      supervisor.poll(bus.now_ns());
      bus.advance_to(bus.now_ns() + kMillisecond_ns);
      hal::CanFrame frame;
      while (foot.receive(frame)) {
        SupervisorOrder order;
        SupervisorConnect connect;
        if (decode(frame, connect) == DecodeResult::kOk) {
          connects.push_back(connect);
          if (welcomes) answer_connect(connect, OrderResult::kAccepted);
          continue;
        }
        REQUIRE(decode(frame, order) == DecodeResult::kOk);
        orders.push_back(order);
      }
    }
    return orders;
  }

  std::vector<SupervisorOrder> after_heartbeat(const Heartbeat& heartbeat = healthy()) {
    foot.send(encode(heartbeat));
    return run(4);
  }

  std::vector<SupervisorOrder> after_answer(const SupervisorOrder& order, OrderResult result,
                                            int expected_counter, std::uint8_t id = kId) {
    OrderAcknowledge answer;
    answer.supervisor_id = id;
    answer.counter = order.counter;
    answer.result = result;
    answer.mode = Mode::kHoming;
    answer.expected_counter = static_cast<std::uint8_t>(expected_counter);
    foot.send(encode(answer));
    return run(3);
  }

  static Heartbeat healthy() {
    Heartbeat heartbeat;
    heartbeat.protocol_hash = kHeartbeatHash;
    return heartbeat;
  }
};

}  // namespace

TEST_CASE("orders wait for the foot's heartbeat and are repeated until they are answered") {
  Bench bench;
  bench.supervisor.order(Order::kReady, 0.35);
  CHECK(bench.run(100).empty());
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  CHECK(first[0].supervisor_id == kId);
  CHECK(first[0].order == Order::kReady);
  CHECK(first[0].toe_angle_rad == Approx(0.35).margin(5e-5));  // half a step of the wire
  const auto repeated = bench.run(100);
  CHECK(repeated.size() == 5);  // every 20 ms
  for (const SupervisorOrder& order : repeated) CHECK(order.counter == first[0].counter);
  CHECK_FALSE(bench.supervisor.accepted());
  CHECK(bench.supervisor.trouble().empty());
}

TEST_CASE("an accepted order is not sent again, and the next one carries the expected counter") {
  Bench bench;
  bench.supervisor.order(Order::kReady, 0.1);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  CHECK(bench.after_answer(first[0], OrderResult::kAccepted, 41).empty());
  CHECK(bench.supervisor.accepted());
  REQUIRE(bench.supervisor.mode());
  CHECK(*bench.supervisor.mode() == Mode::kHoming);
  CHECK(bench.run(100).empty());
  bench.supervisor.order(Order::kRun, 0.1, 0.45);
  CHECK_FALSE(bench.supervisor.accepted());
  const auto second = bench.run(2);
  REQUIRE(second.size() == 1);
  CHECK(second[0].order == Order::kRun);
  CHECK(second[0].counter == 41);
  CHECK(second[0].frequency_Hz == Approx(0.45).margin(5e-4));
}

TEST_CASE("a bad counter is learnt from, at once") {
  Bench bench;
  bench.supervisor.order(Order::kStop);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  const auto second = bench.after_answer(first[0], OrderResult::kBadCounter, 200);
  REQUIRE(second.size() == 1);
  CHECK(second[0].counter == 200);
  CHECK(bench.supervisor.trouble().empty());
  bench.after_answer(second[0], OrderResult::kAccepted, 201);
  CHECK(bench.supervisor.accepted());
}

TEST_CASE("answers to others and to older orders count for nothing") {
  Bench bench;
  bench.supervisor.order(Order::kStop);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  bench.after_answer(first[0], OrderResult::kAccepted, 1, kId + 1);
  CHECK_FALSE(bench.supervisor.accepted());
  SupervisorOrder older = first[0];
  older.counter = 99;
  bench.after_answer(older, OrderResult::kAccepted, 1);
  CHECK_FALSE(bench.supervisor.accepted());
}

TEST_CASE("an order replaced before its answer came is not taken for accepted by that answer") {
  Bench bench;
  bench.supervisor.order(Order::kReady, 0.1);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  bench.supervisor.order(Order::kStop);
  CHECK(bench.run(5).empty());  // two orders of one counter could not be told apart
  const auto second = bench.after_answer(first[0], OrderResult::kAccepted, 1);
  CHECK_FALSE(bench.supervisor.accepted());
  REQUIRE(second.size() == 1);
  CHECK(second[0].order == Order::kStop);
  CHECK(second[0].counter == 1);
  bench.after_answer(second[0], OrderResult::kAccepted, 2);
  CHECK(bench.supervisor.accepted());
}

TEST_CASE("a replaced order goes out even where the first one is never answered") {
  Bench bench;
  bench.supervisor.order(Order::kReady, 0.1);
  REQUIRE(bench.after_heartbeat().size() == 1);
  bench.supervisor.order(Order::kStop);
  const auto sent = bench.run(25);
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].order == Order::kStop);
}

TEST_CASE("a refused order is told in words and not sent again") {
  Bench bench;
  bench.supervisor.order(Order::kRun, 0.1, 0.5);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  bench.after_answer(first[0], OrderResult::kNoLeg, 1);
  CHECK(bench.supervisor.trouble() == "the order 'run' was refused: no_leg (mode homing)");
  CHECK_FALSE(bench.supervisor.accepted());
  CHECK(bench.run(100).empty());
}

TEST_CASE("a firmware of another dictionary gets no orders") {
  Bench bench;
  bench.supervisor.order(Order::kReady);
  Heartbeat foreign = Bench::healthy();
  foreign.protocol_hash ^= 1;
  CHECK(bench.after_heartbeat(foreign).empty());
  CHECK_FALSE(bench.supervisor.heartbeat());
  CHECK(bench.supervisor.trouble() ==
        "the firmware speaks another dictionary: its protocol hash is " +
            std::to_string(foreign.protocol_hash) + ", ours " + std::to_string(kHeartbeatHash));
  CHECK(bench.run(100).empty());
}

TEST_CASE("faults in the heartbeat are named") {
  Bench bench;
  Heartbeat ill = Bench::healthy();
  ill.mode = Mode::kDampedStop;
  ill.faults = 1u << 1 | 1u << 14;
  bench.after_heartbeat(ill);
  REQUIRE(bench.supervisor.heartbeat());
  CHECK(bench.supervisor.trouble() ==
        "the firmware reports drive_lost, emergency_stop in mode damped_stop");
}

TEST_CASE("faults do not keep an order back, for reset is one") {
  Bench bench;
  bench.supervisor.order(Order::kReset);
  Heartbeat ill = Bench::healthy();
  ill.mode = Mode::kFault;
  ill.faults = 1u << 9;
  const auto sent = bench.after_heartbeat(ill);
  REQUIRE(sent.size() == 1);
  CHECK(bench.supervisor.trouble() == "the firmware reports homing_failed in mode fault");
  CHECK(bench.supervisor.refusal().empty());
  bench.after_answer(sent[0], OrderResult::kAccepted, 1);
  bench.after_heartbeat();
  CHECK(bench.supervisor.accepted());
  CHECK(bench.supervisor.trouble().empty());
}

TEST_CASE("after a refusal a new order can be given") {
  Bench bench;
  bench.supervisor.order(Order::kRun, 0.1, 0.5);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  bench.after_answer(first[0], OrderResult::kNoLeg, 1);
  bench.supervisor.order(Order::kReady, 0.1);
  CHECK(bench.supervisor.refusal().empty());
  const auto second = bench.run(2);
  REQUIRE(second.size() == 1);
  CHECK(second[0].order == Order::kReady);
}

TEST_CASE("the toes are known as the foot told them") {
  Bench bench;
  CHECK_FALSE(bench.supervisor.toe());
  bench.foot.send(encode(FootToe{.commanded_rad = 0.5f, .measured_rad = 0.25f, .moving = true}));
  bench.run(2);
  REQUIRE(bench.supervisor.toe());
  CHECK(bench.supervisor.toe()->commanded_rad == Approx(0.5).margin(5e-5));
  CHECK(bench.supervisor.toe()->measured_rad == Approx(0.25).margin(5e-5));
  CHECK(bench.supervisor.toe()->moving);
}

TEST_CASE("it connects before its first order, again until answered, and not before every order") {
  Bench bench;
  bench.welcomes = false;
  bench.expected = 17;
  bench.supervisor.order(Order::kReady, 0.1);
  CHECK(bench.after_heartbeat().empty());
  CHECK(bench.run(61).empty());
  REQUIRE(bench.connects.size() == 4);  // every 20 ms
  CHECK(bench.connects[0].supervisor_id == kId);
  CHECK(bench.connects[0].protocol_hash == kProtocolHash);
  bench.welcomes = true;
  const auto first = bench.run(30);
  REQUIRE(first.size() >= 1);
  CHECK(first[0].counter == 17);  // as the answer told
  bench.after_answer(first[0], OrderResult::kAccepted, 18);
  const std::size_t before = bench.connects.size();
  bench.supervisor.order(Order::kRun, 0.1, 0.5);
  CHECK(bench.run(2).size() == 1);
  CHECK(bench.connects.size() == before);
}

TEST_CASE("a connection that lapsed is made anew and the order goes out again") {
  Bench bench;
  bench.supervisor.order(Order::kReady, 0.1);
  const auto first = bench.after_heartbeat();
  REQUIRE(first.size() == 1);
  const std::size_t before = bench.connects.size();
  CHECK(bench.after_answer(first[0], OrderResult::kNotConnected, 0).empty());
  const auto again = bench.run(3);
  CHECK(bench.connects.size() == before + 1);
  REQUIRE(again.size() == 1);
  CHECK(again[0].order == Order::kReady);
  CHECK(bench.supervisor.refusal().empty());
}

TEST_CASE("a foot that refuses the dictionary gets no orders, and it is said why") {
  Bench bench;
  bench.welcomes = false;
  bench.supervisor.order(Order::kReady, 0.1);
  bench.after_heartbeat();
  REQUIRE(bench.connects.size() == 1);
  bench.answer_connect(bench.connects[0], OrderResult::kOtherDictionary);
  CHECK(bench.run(100).empty());
  CHECK(bench.supervisor.trouble() ==
        "the firmware speaks another dictionary and refuses ours, whose protocol hash is " +
            std::to_string(kProtocolHash));
}

TEST_CASE("a stop does not wait to be introduced") {
  Bench bench;
  bench.welcomes = false;
  bench.supervisor.order(Order::kStop);
  const auto sent = bench.after_heartbeat();
  REQUIRE(sent.size() == 1);
  CHECK(sent[0].order == Order::kStop);
  CHECK(bench.connects.empty());
}
