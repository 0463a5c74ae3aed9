// In lock-step with another process the firmware is asked only where it may have something to do.
// That must give the same frames as asking it in every exchange interval.
#include <catch2/catch.hpp>
#include <deque>
#include <random>

#include "hil_bridge/firmware_node.h"
#include "tests/hil_bridge/rigid_bench.h"

using namespace hoof;
using test::SeenFrame;
namespace protocol = firmware::protocol;

namespace {

/// Asked by the rule of RemoteFoot, in this process.
class SelectiveFirmware final : public bridge::FirmwareNode {
 public:
  SelectiveFirmware(hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock,
                    const firmware::app::Parameters& parameters, int& polls)
      : wires_{&bus0, &bus1},
        queues_{Queue(bus0), Queue(bus1)},
        clock_(clock),
        loop_({&queues_[0], &queues_[1]}, clock, board_, parameters),
        polls_(polls) {}

  void poll(std::uint32_t) override {
    bool any = false;
    for (int bus = 1; bus >= 0; --bus) {
      hal::CanFrame frame;
      while (wires_[bus]->receive(frame)) {
        queues_[bus].waiting.push_back(frame);
        any = true;
      }
    }
    if (!any && clock_.now_ns() < due_ns_) return;
    ++polls_;
    loop_.poll();
    due_ns_ = loop_.next_due_ns();
  }
  const firmware::app::Telemetry& telemetry() const override { return loop_.telemetry(); }
  firmware::control::Mode mode() const override { return loop_.mode(); }

 private:
  struct Queue final : hal::CanBus {
    explicit Queue(hal::CanBus& wire) : wire(wire) {}
    hal::SendResult send(const hal::CanFrame& frame) override { return wire.send(frame); }
    void withdraw(std::uint32_t id) override { wire.withdraw(id); }
    bool receive(hal::CanFrame& frame) override {
      if (waiting.empty()) return false;
      frame = waiting.front();
      waiting.pop_front();
      return true;
    }
    hal::BusStatus status() const override { return wire.status(); }

    hal::CanBus& wire;
    std::deque<hal::CanFrame> waiting;
  };

  std::array<hal::CanBus*, 2> wires_;
  std::array<Queue, 2> queues_;
  const hal::Clock& clock_;
  hal::SoftBoard board_;
  firmware::app::ControlLoop loop_;
  int& polls_;
  std::int64_t due_ns_ = 0;
};

struct Recorded {
  std::vector<SeenFrame> frames;
  int polls = 0;
};

/// Orders, an e-stop and floods come at random times of the seed; SYNC goes on.
Recorded record(const std::string& kind, bool selective, unsigned seed) {
  Recorded r;
  const tools::RunSettings run = test::rigid_run(kind);
  const auto experiment = test::rigid_bench(run);
  const auto wires = bridge::in_process_wires([&r](int bus, const hal::CanFrame& frame) {
    r.frames.push_back({bus, frame});
  });
  const bridge::FirmwareMaker maker =
      [&](hal::CanBus& bus0, hal::CanBus& bus1,
          const hal::Clock& clock) -> std::unique_ptr<bridge::FirmwareNode> {
    if (selective) {
      return std::make_unique<SelectiveFirmware>(bus0, bus1, clock, run.parameters, r.polls);
    }
    return std::make_unique<bridge::LocalFirmware>(bus0, bus1, clock, run.parameters);
  };
  bridge::LockStep lock_step(*experiment, maker, *wires);
  hal::CanBus& stranger = wires->attach(0, "stranger");
  std::mt19937 random(seed);
  for (int tick = 0; tick < 1'500; ++tick) {
    switch (random() % 100) {
      case 0:
        lock_step.supervisor().order(protocol::Order::kReady, 0.01 * double(random() % 30));
        break;
      case 1:
        lock_step.supervisor().order(protocol::Order::kRun, 0.1, 0.45);
        break;
      case 2:
        lock_step.supervisor().order(random() % 2 ? protocol::Order::kStop
                                                  : protocol::Order::kReset);
        break;
      case 3:  // full mailboxes and a busy wire: what waits must go out at the same times
        for (int i = 0; i < 3; ++i) stranger.send(encode(protocol::Sync{1}));
        break;
      case 4:
        if (random() % 10 == 0) stranger.send(encode(protocol::EmergencyStop{7, 0}));
        break;
      default:
        break;
    }
    lock_step.tick();
  }
  return r;
}

}  // namespace

TEST_CASE("a firmware that is asked only when it is due sends the same frames at the same times") {
  const auto kind = GENERATE(as<std::string>{}, "sinkage", "traction");
  const auto seed = GENERATE(11u, 12u, 13u);
  CAPTURE(kind, seed);
  const Recorded all = record(kind, false, seed);
  const Recorded few = record(kind, true, seed);
  REQUIRE(few.frames.size() == all.frames.size());
  for (std::size_t i = 0; i < all.frames.size(); ++i) {
    CAPTURE(i, all.frames[i].frame.id, few.frames[i].frame.id);
    REQUIRE(few.frames[i].bus == all.frames[i].bus);
    REQUIRE(few.frames[i].frame == all.frames[i].frame);
    REQUIRE(few.frames[i].frame.stamp_ns == all.frames[i].frame.stamp_ns);
  }
  CHECK(few.polls < 1'500 * 20 / 3);  // or the test would show nothing
}
