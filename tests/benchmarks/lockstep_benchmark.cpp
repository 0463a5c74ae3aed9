// Ticks per second of lock-step without sand: firmware, buses, drives and supervisor, on a rig
// whose joints are held and on the real rig over a hard floor; in one process, and with --bus over
// a CAN interface beside the bare exchange of the same frames. One JSON line a case.
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <stdexcept>
#include <string>

#include "firmware/protocol/codec.h"
#include "hil_bridge/lock_step.h"
#include "tests/benchmarks/lockstep_rigs.h"
#include "tests/benchmarks/remote_firmware.h"

namespace {

using namespace hoof;
namespace protocol = firmware::protocol;
using namespace hoof::benchmarks;

/// By the wall, and of this thread's processor: on a machine that does something else as well the
/// second one tells what the code costs.
struct Elapsed {
  double wall_s = 0;
  double cpu_s = 0;
};

double now_s(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

Elapsed elapsed_of(const std::function<void()>& work) {
  const Elapsed start = {now_s(CLOCK_MONOTONIC), now_s(CLOCK_THREAD_CPUTIME_ID)};
  work();
  return {now_s(CLOCK_MONOTONIC) - start.wall_s, now_s(CLOCK_THREAD_CPUTIME_ID) - start.cpu_s};
}

void print(const std::string& name, int ticks, const Elapsed& e, double frames) {
  std::printf(
      "{\"case\": \"%s\", \"ticks\": %d, \"ticks_per_s\": %.0f, \"us_per_tick\": %.2f, "
      "\"own_cpu_us_per_tick\": %.2f, \"frames_per_tick\": %.2f}\n",
      name.c_str(), ticks, ticks / e.wall_s, e.wall_s / ticks * 1e6, e.cpu_s / ticks * 1e6,
      frames / ticks);
  std::fflush(stdout);
}

/// @return microseconds of a tick
double measure(const std::string& name, sim::Experiment& experiment,
               const bridge::FirmwareMaker& firmware, bridge::Wires& wires, int ticks) {
  bridge::LockStep lock_step(experiment, firmware, wires);
  lock_step.supervisor().order(protocol::Order::kReady, 0.0);
  for (int i = 0; i < 100; ++i) lock_step.tick();
  const auto before = double(wires.frames());
  const Elapsed elapsed = elapsed_of([&] {
    for (int i = 0; i < ticks; ++i) lock_step.tick();
  });
  if (!lock_step.firmware().lost().empty()) throw std::runtime_error(lock_step.firmware().lost());
  print(name, ticks, elapsed, double(wires.frames()) - before);
  return elapsed.wall_s / ticks * 1e6;
}

bridge::FirmwareMaker local(const tools::RunSettings& run) {
  return [&run](hal::CanBus& bus0, hal::CanBus& bus1, const hal::Clock& clock) {
    return std::make_unique<bridge::LocalFirmware>(bus0, bus1, clock, run.parameters);
  };
}

/// The same frames a tick, and nothing else: SYNC and replies one way, commands and now and then a
/// telemetry frame back. Plain blocking read() and write() of the kernel, one a frame: what an
/// exchange of these frames between two processes costs on this machine at best.
class PingPong {
 public:
  PingPong(int drives, int telemetry_per_10, const std::string& interface)
      : drives_(drives), telemetry_per_10_(telemetry_per_10), interface_(interface) {}

  /// @return microseconds a tick
  double measure(const std::string& name, int ticks) const {
    const int near = open_socket();
    const pid_t child = fork();
    if (child == 0) answer(open_socket());
    receive(near);  // the far end is there
    const Elapsed elapsed = elapsed_of([&] {
      for (int i = 0; i < ticks; ++i) tick(near, i);
    });
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(near);
    print(name, ticks, elapsed, (1 + 2 * drives_ + 0.1 * telemetry_per_10_) * ticks);
    return elapsed.wall_s / ticks * 1e6;
  }

 private:
  int back(int tick) const { return drives_ + (tick % 10 < telemetry_per_10_ ? 1 : 0); }

  void tick(int fd, int number) const {
    send(fd, 0x10, 4);
    for (int i = 0; i < back(number); ++i) receive(fd);
    for (int i = 0; i < drives_; ++i) send(fd, 0x20, 8);
  }

  [[noreturn]] void answer(int fd) const {
    send(fd, 0x700, 8);
    for (int tick = 0;; ++tick) {
      while (receive(fd) != 0x10) {
      }
      for (int i = 0; i < back(tick); ++i) send(fd, 0x30, 8);
    }
  }

  int open_socket() const {
    const int fd = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = int(if_nametoindex(interface_.c_str()));
    if (bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error("ping-pong: " + interface_ + " is not there");
    }
    return fd;
  }

  static void send(int fd, canid_t id, int length) {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = static_cast<__u8>(length);
    if (write(fd, &frame, sizeof frame) != ssize_t(sizeof frame)) {
      throw std::runtime_error("ping-pong: a frame was not taken");
    }
  }

  static canid_t receive(int fd) {
    can_frame frame{};
    if (read(fd, &frame, sizeof frame) != ssize_t(sizeof frame)) {
      throw std::runtime_error("ping-pong: no frame");
    }
    return frame.can_id;
  }

  int drives_;
  int telemetry_per_10_;
  std::string interface_;
};

double measure_ping_pong(const std::string& kind, const std::string& interface, int ticks) {
  const bool toe_only = kind == "sinkage";
  return PingPong(toe_only ? 1 : 3, toe_only ? 3 : 5, interface)
      .measure("ping-pong of the frames of " + kind + " over " + interface, ticks);
}

double measure_remote(const std::string& kind, const std::string& interface, int ticks) {
  const tools::RunSettings run = rigid_settings(kind);
  RemoteFirmware firmware(run, interface);
  const auto experiment = held(run);
  const auto wires = bridge::in_process_wires({});
  return measure(kind + ", held joints, firmware in another process over " + interface, *experiment,
                 firmware.maker(*wires), *wires, ticks);
}

/// In turns, the best of each: what else the machine does only ever makes a round slower.
constexpr int kRounds = 5;

void compare_over(const std::string& kind, const std::string& interface, int ticks) {
  double bare_us = 1e12, us = 1e12;
  for (int round = 0; round < kRounds; ++round) {
    bare_us = std::min(bare_us, measure_ping_pong(kind, interface, ticks));
    us = std::min(us, measure_remote(kind, interface, ticks));
  }
  std::printf(
      "{\"case\": \"%s over %s: lock-step over ping-pong, best of %d rounds\", "
      "\"lock_step_us\": %.2f, \"ping_pong_us\": %.2f, \"ratio\": %.2f}\n",
      kind.c_str(), interface.c_str(), kRounds, us, bare_us, us / bare_us);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Ticks per second of lock-step without sand");
  std::string interface;
  int ticks = 20'000;
  app.add_option("--bus", interface, "also over this CAN interface, e.g. vcan0");
  std::string rig = "both";
  app.add_option("--rig", rig, "held joints, the real rig, or both")
      ->check(CLI::IsMember({"held", "real", "both"}));
  app.add_option("--ticks", ticks, "of each case")->check(CLI::Range(100, 10'000'000));
  CLI11_PARSE(app, argc, argv);
  for (const std::string kind : {"sinkage", "traction"}) {
    const tools::RunSettings run = rigid_settings(kind);
    for (const bool moves : {false, true}) {
      if (rig == (moves ? "held" : "real")) continue;
      const auto experiment = moves ? on_floor(run) : held(run);
      const auto wires = bridge::in_process_wires({});
      measure(kind + (moves ? ", real rig over a hard floor, in one process"
                            : ", held joints, in one process"),
              *experiment, local(run), *wires, moves ? ticks / 10 : ticks);
    }
    if (interface.empty()) continue;
    compare_over(kind, interface, ticks / kRounds);
  }
  return 0;
}
