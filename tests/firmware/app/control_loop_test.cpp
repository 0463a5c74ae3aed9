#include "firmware/app/control_loop.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "firmware/protocol/bus_load.h"
#include "firmware/protocol/protocol_hash.h"
#include "tests/firmware/app/loop_bench.h"

using namespace hoof::firmware;
using app::test::LoopBench;
using control::Mode;
using protocol::Order;
using protocol::OrderResult;

namespace {
constexpr double kDegree_rad = 3.14159265358979 / 180.0;
}

TEST_CASE("Off: one exit frame per drive and tick, so every drive's state is known") {
  LoopBench bench;
  bench.run(50);
  CHECK(bench.loop->mode() == Mode::kOff);
  CHECK(bench.drives_free());
  CHECK(bench.toe.commands == 50);
  CHECK(bench.hip.commands == 50);
  CHECK(bench.loop->telemetry().state[1].position_rad == Approx(0.5).margin(1e-4));
  CHECK(bench.loop->telemetry().counters.bad_frames() == 0);
}

TEST_CASE("The main job: home, open the toes, hold them, walk the ellipse, stop") {
  LoopBench bench;
  bench.run(10);
  REQUIRE(bench.order(Order::kReady, 0.5236f) == OrderResult::kAccepted);
  REQUIRE(bench.run_until(Mode::kReady) > 0);
  bench.run(3000);
  CHECK(bench.toe.plant.q_rad == Approx(0.5236).margin(0.5 * kDegree_rad));
  CHECK(bench.loop->telemetry().state[0].position_rad == Approx(0.5236).margin(1e-3));

  bench.toe.plant.load_Nm = -1.5;
  bench.run(500);
  CHECK(std::abs(bench.toe.plant.q_rad - 0.5236) < 0.5 * kDegree_rad);

  REQUIRE(bench.order(Order::kRun, 0.5236f, 1.12f) == OrderResult::kAccepted);
  REQUIRE(bench.run_until(Mode::kRunning) >= 0);
  bench.run(2000);
  const app::Telemetry& t = bench.loop->telemetry();
  CHECK(t.gait_rate_Hz == 1.12f);
  CHECK(std::hypot(t.foot_m.x - t.foot_set_point_m.x, t.foot_m.z - t.foot_set_point_m.z) < 0.01);
  CHECK(t.gate_interventions == 0);
  CHECK(t.counters.bad_frames() == 0);
  CHECK(t.counters.missed_ticks == 0);

  REQUIRE(bench.order(Order::kStop) == OrderResult::kAccepted);
  REQUIRE(bench.run_until(Mode::kOff) > 0);
  bench.run(2);
  CHECK(bench.drives_free());
  CHECK(bench.loop->faults() == 0);
}

TEST_CASE("Toe gain by parameter: half holds half as well, none not at all") {
  double deflection_rad[3] = {};
  const float gains[3] = {250.0f, 125.0f, 0.0f};
  for (int i = 0; i < 3; ++i) {
    app::Parameters parameters = app::test::calibrated();
    REQUIRE(app::set(parameters, "toe_kp_Nm_rad", gains[i]) == app::SetResult::kOk);
    REQUIRE(app::set(parameters, "leg_present", 0.0f) == app::SetResult::kOk);
    LoopBench bench(parameters);
    bench.order(Order::kReady, 0.5236f);
    REQUIRE(bench.run_until(Mode::kReady) > 0);
    bench.run(1000);
    const double before_rad = bench.toe.plant.q_rad;
    CHECK(before_rad == Approx(0.5236).margin(0.03));
    bench.toe.plant.load_Nm = -1.5;
    bench.run(400);
    deflection_rad[i] = bench.toe.plant.q_rad - before_rad;
    CHECK(bench.loop->faults() == 0);
    CHECK(bench.hip.commands == 0);  // not there: not commanded
  }
  CHECK(std::abs(deflection_rad[0]) < 0.5 * kDegree_rad);
  CHECK(deflection_rad[1] / deflection_rad[0] == Approx(2.0).epsilon(0.1));
  CHECK(std::abs(deflection_rad[2]) > 5.0 * kDegree_rad);
}

TEST_CASE("Heartbeat: ten a second, at once on change, with mode, faults and protocol hash") {
  LoopBench bench;
  bench.run(1000);
  CHECK(bench.heartbeats.size() == Approx(10).margin(1));
  CHECK(bench.heartbeats.back().protocol_hash == protocol::kHeartbeatHash);
  const std::size_t before = bench.heartbeats.size();
  bench.order(Order::kReady, 0.1f);
  bench.run(12);
  REQUIRE(bench.heartbeats.size() > before);
  CHECK(bench.heartbeats.back().mode == protocol::Mode::kHoming);
}

TEST_CASE("Real bus load while running stays below the worst case computed") {
  LoopBench bench;
  bench.order(Order::kRun, 0.5f, 1.0f);
  REQUIRE(bench.run_until(Mode::kRunning) > 0);
  bench.run(1000);
  CHECK(bench.bus0.mean_load_ratio() < protocol::worst_load_ratio(protocol::kBus0));
  CHECK(bench.bus1.mean_load_ratio() < protocol::worst_load_ratio(protocol::kBus1));
  CHECK(bench.bus0.mean_load_ratio() > 0.25);
  CHECK(bench.bus1.mean_load_ratio() > 0.4);
  CHECK(bench.loop->telemetry().counters.unsent_frames == 0);
}

TEST_CASE("A slow master changes nothing: the same ticks give the same commands") {
  std::vector<protocol::DriveCommand> commands[2];
  for (int slow = 0; slow < 2; ++slow) {
    LoopBench bench;
    bench.send_order(Order::kRun, 0.4f, 1.0f);
    for (int i = 0; i < 3000; ++i) {
      bench.millisecond();
      commands[slow].push_back(bench.hip.last.command);
      if (slow == 0 || i % 10 != 0) continue;
      // The plant stands still for 5 ms while the simulator computes.
      bench.sync = false;
      for (int wait = 0; wait < 100; ++wait) {
        const std::int64_t t_ns = bench.clock.now_ns() + 50'000;
        bench.bus0.advance_to(t_ns);
        bench.bus1.advance_to(t_ns);
        bench.clock.advance_to(t_ns);
        bench.loop->poll();
      }
      bench.sync = true;
    }
    CHECK(bench.loop->faults() == 0);
  }
  int different = 0;
  for (std::size_t i = 0; i < commands[0].size(); ++i) {
    different += commands[0][i].position_rad != commands[1][i].position_rad;
    different += commands[0][i].torque_Nm != commands[1][i].torque_Nm;
  }
  CHECK(different == 0);
}

TEST_CASE("Telemetry frames carry what the loop knows") {
  LoopBench bench;
  hoof::hal::InProcessPort& listener = bench.bus0.attach("listener");
  listener.set_filters({{.id = 0x060, .mask = 0x7F8}});
  bench.order(Order::kReady, 0.3f);
  bench.run(4000);
  hoof::hal::CanFrame frame;
  while (listener.receive(frame)) {
  }
  bench.run(20);
  int toe = 0, leg = 0, ground = 0, gate = 0;
  while (listener.receive(frame)) {
    protocol::FootToe t;
    protocol::FootLeg l;
    protocol::FootGround g;
    protocol::FootGate w;
    if (decode(frame, t) == protocol::DecodeResult::kOk) {
      ++toe;
      CHECK(t.commanded_rad == Approx(0.3).margin(1e-4));
      CHECK(t.measured_rad == Approx(0.3).margin(1e-3));
    }
    if (decode(frame, l) == protocol::DecodeResult::kOk) {
      ++leg;
      CHECK(l.foot_z_m == Approx(0.045).margin(1.5e-3));  // top of the path
    }
    if (decode(frame, g) == protocol::DecodeResult::kOk) {
      ++ground;
      CHECK(g.phase_cycles == Approx(0.75).margin(1e-4));
    }
    if (decode(frame, w) == protocol::DecodeResult::kOk) {
      ++gate;
      CHECK(w.interventions == 0);
    }
  }
  CHECK((toe == 2 && leg == 2 && ground == 2 && gate == 2));
}
