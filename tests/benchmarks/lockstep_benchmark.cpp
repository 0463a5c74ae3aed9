// Ticks per second of lock-step without sand: firmware, buses, drives and supervisor, on a rig
// whose joints are held and on the real rig over a hard floor; in one process, and with --bus over
// a CAN interface beside the bare exchange of the same frames. One JSON line a case.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>

#include "firmware/protocol/codec.h"
#include "hal/socketcan/socketcan_bus.h"
#include "hil_bridge/lock_step.h"
#include "hil_bridge/remote_foot.h"
#include "tools/experiment/bench.h"
#include "tools/experiment/run_settings.h"

namespace {

using namespace hoof;
namespace protocol = firmware::protocol;

/// All joints where they were; a single body far above the ground.
class HeldRig final : public sim::Rig {
 public:
  explicit HeldRig(bool leg) : joints_{sim::Joint::kToe, sim::Joint::kHip, sim::Joint::kKnee} {
    count_ = leg ? 3 : 1;
    mesh_.vertices_m = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}};
    mesh_.triangles = {{0, 1, 2}};
    pose_.p_WB_m.z() = 1;
  }
  int body_count() const override { return 1; }
  const sim::TriangleMesh& mesh(int) const override { return mesh_; }
  sim::Pose pose(int) const override { return pose_; }
  std::span<const sim::Joint> joints() const override { return {joints_.data(), count_}; }
  double joint_position_rad(sim::Joint joint) const override {
    return joint == sim::Joint::kKnee ? -1.0 : 0.0;
  }
  double joint_velocity_rad_s(sim::Joint) const override { return 0; }
  void apply_joint_torque(sim::Joint, double) override {}
  void apply_wrench(int, const sim::Wrench&) override {}
  void step(double) override {}
  sim::RigEnergy energy() const override { return {}; }
  Eigen::Vector3d foot_velocity_m_s() const override { return Eigen::Vector3d::Zero(); }
  double toe_opening_rad(int) const override { return 0; }

 private:
  std::array<sim::Joint, 3> joints_;
  std::size_t count_;
  sim::TriangleMesh mesh_;
  sim::Pose pose_;
};

class Endless final : public sim::Experiment {
 public:
  explicit Endless(std::unique_ptr<sim::Plant> plant) : Experiment(std::move(plant)) {}
  void foot_ready() override {}
  bool finished() const override { return false; }
  double progress() const override { return 0; }

 protected:
  void after_interval() override {}
  double depth_m() const override { return 0; }
};

tools::RunSettings settings_of(const std::string& kind) {
  return tools::read_run_settings(kind, {"experiment.terrain=\"rigid\""});
}

std::unique_ptr<sim::Experiment> held(const tools::RunSettings& run) {
  return std::make_unique<Endless>(
      std::make_unique<sim::Plant>(std::make_unique<HeldRig>(run.firmware_leg()), run.drives,
                                   std::make_unique<sim::RigidTerrain>(run.rigid), run.coupling));
}

std::unique_ptr<sim::Experiment> real(const tools::RunSettings& run) {
  return tools::make_experiment(
      run, [](double) { return true; }, [](const std::string&) {});
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print(const std::string& name, int ticks, double seconds, double frames) {
  std::printf(
      "{\"case\": \"%s\", \"ticks\": %d, \"ticks_per_s\": %.0f, \"us_per_tick\": %.2f, "
      "\"frames_per_tick\": %.2f}\n",
      name.c_str(), ticks, ticks / seconds, seconds / ticks * 1e6, frames / ticks);
  std::fflush(stdout);
}

/// @return microseconds of a tick
double measure(const std::string& name, sim::Experiment& experiment,
               const bridge::FirmwareMaker& firmware, bridge::Wires& wires, int ticks) {
  bridge::LockStep lock_step(experiment, firmware, wires);
  lock_step.supervisor().order(protocol::Order::kReady, 0.0);
  for (int i = 0; i < 100; ++i) lock_step.tick();
  const auto before = double(wires.frames());
  const double seconds = seconds_of([&] {
    for (int i = 0; i < ticks; ++i) lock_step.tick();
  });
  if (!lock_step.firmware().lost().empty()) throw std::runtime_error(lock_step.firmware().lost());
  print(name, ticks, seconds, double(wires.frames()) - before);
  return seconds / ticks * 1e6;
}

bridge::FirmwareMaker local(const tools::RunSettings& run) {
  return [&run](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    return std::make_unique<bridge::LocalFirmware>(bus0, bus1, clock, run.parameters);
  };
}

/// The same frames a tick, and nothing else: SYNC and replies one way, commands and every second
/// tick a telemetry frame back.
struct PingPong {
  int drives;
  int telemetry_per_10;

  /// Runs for ever: the far end.
  void answer(hal::SocketCanBus& bus) const {
    hal::CanFrame frame;
    int tick = 0;
    for (;;) {
      bus.wait(1'000'000'000);
      while (bus.receive(frame)) {
        if (frame.id != protocol::spec(protocol::Message::kSync).id) continue;
        for (int i = 0; i < drives; ++i) bus.send(command(i));
        if (tick++ % 10 < telemetry_per_10) bus.send(encode(protocol::FootToe{}));
      }
    }
  }

  void tick(hal::SocketCanBus& bus, int number) const {
    bus.send(encode(protocol::Sync{std::uint32_t(number)}));
    int missing = drives + (number % 10 < telemetry_per_10 ? 1 : 0);
    hal::CanFrame frame;
    while (missing > 0) {
      if (!bus.wait(1'000'000'000)) throw std::runtime_error("ping-pong: no answer");
      while (missing > 0 && bus.receive(frame)) --missing;
    }
    for (int i = 0; i < drives; ++i) bus.send(reply(i));
  }

  static hal::CanFrame command(int drive) {
    return encode_command(protocol::kDrives[std::size_t(drive)], {});
  }
  static hal::CanFrame reply(int drive) {
    return encode_reply(protocol::kDrives[std::size_t(drive)], {});
  }
};

double measure_ping_pong(const std::string& kind, const std::string& interface, int ticks) {
  const PingPong ping_pong = kind == "sinkage" ? PingPong{1, 3} : PingPong{3, 5};
  hal::SocketCanSettings settings;
  settings.interface = interface;
  hal::SocketCanBus near(settings);
  const pid_t child = fork();
  if (child == 0) {
    hal::SocketCanBus far(settings);
    // The near end's SYNC may come before this; it then waits and says so.
    far.send(encode(protocol::Heartbeat{}));
    ping_pong.answer(far);
  }
  hal::CanFrame frame;
  near.wait(2'000'000'000);
  while (near.receive(frame)) {
  }
  const double seconds = seconds_of([&] {
    for (int i = 0; i < ticks; ++i) ping_pong.tick(near, i);
  });
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const double frames = 1 + 2 * ping_pong.drives + 0.1 * ping_pong.telemetry_per_10;
  print("ping-pong of the frames of " + kind + " over " + interface, ticks, seconds,
        frames * ticks);
  return seconds / ticks * 1e6;
}

double measure_remote(const std::string& kind, const std::string& interface, int ticks) {
  const tools::RunSettings run = settings_of(kind);
  const pid_t child = fork();
  if (child == 0) {
    execl(HOOF_FIRMWARE, HOOF_FIRMWARE, "--bus", interface.c_str(), "--clock", "lock-step",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  double us = 0;
  {
    bridge::RemoteLine line(interface);
    line.await_heartbeat(5'000'000'000);
    line.pass_parameters(run.parameters, 5'000'000'000);
    const auto experiment = held(run);
    const auto wires = bridge::in_process_wires({});
    const bridge::FirmwareMaker remote = [&](hal::CanBus& bus0, hal::CanBus& bus1,
                                             const hal::Clock& clock) {
      const std::array<hal::CanBus*, bridge::kBusCount> visitors = {&wires->attach(0, "visitor"),
                                                                    &wires->attach(1, "visitor")};
      return std::make_unique<bridge::RemoteFoot>(line, std::array{&bus0, &bus1}, visitors, clock,
                                                  5'000'000'000);
    };
    us = measure(kind + ", held joints, firmware in another process over " + interface, *experiment,
                 remote, *wires, ticks);
  }
  kill(child, SIGTERM);
  waitpid(child, nullptr, 0);
  return us;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Ticks per second of lock-step without sand");
  std::string interface;
  int ticks = 20'000;
  app.add_option("--bus", interface, "also over this CAN interface, e.g. vcan0");
  app.add_option("--ticks", ticks, "of each case")->check(CLI::Range(100, 10'000'000));
  CLI11_PARSE(app, argc, argv);
  for (const std::string kind : {"sinkage", "traction"}) {
    const tools::RunSettings run = settings_of(kind);
    for (const bool moves : {false, true}) {
      const auto experiment = moves ? real(run) : held(run);
      const auto wires = bridge::in_process_wires({});
      measure(kind + (moves ? ", real rig over a hard floor, in one process"
                            : ", held joints, in one process"),
              *experiment, local(run), *wires, moves ? ticks / 10 : ticks);
    }
    if (interface.empty()) continue;
    const double bare_us = measure_ping_pong(kind, interface, ticks);
    const double us = measure_remote(kind, interface, ticks);
    std::printf("{\"case\": \"%s over %s: lock-step over ping-pong\", \"ratio\": %.2f}\n",
                kind.c_str(), interface.c_str(), us / bare_us);
  }
  return 0;
}
