// The firmware on Linux: the same control loop on SocketCAN, in place of a board.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <iostream>
#include <optional>
#include <string>

#include "firmware/app/control_loop.h"
#include "firmware/app/received_ids.h"
#include "firmware/board/host/lock_step_foot.h"
#include "firmware/board/host/options.h"
#include "firmware/board/host/scaled_clock.h"
#include "hal/file_flash/file_flash.h"
#include "hal/in_process/soft_board.h"
#include "hal/socketcan/socketcan_bus.h"

namespace {

using namespace hoof::firmware;

std::atomic<bool> interrupted{false};

void on_signal(int) {
  interrupted = true;
}

/// Sleeps at most this long: also without frames the loop looks at its clock every millisecond.
constexpr std::int64_t kLongestSleep_ns = 500'000;

/// A leg is let down within two seconds of ticks; on a machine that does not come to a thousand
/// ticks a second the program does not outlive its user for that.
constexpr std::int64_t kLongestStop_ns = 3'000'000'000;

/// As on the STM32F405: two sectors of parameters, one of faults, 16 KB each.
constexpr std::size_t kFlashSectors = 3;
constexpr std::size_t kFlashSectorWords = 4096;

bool drives_off(control::Mode mode) {
  return mode == control::Mode::kOff || mode == control::Mode::kEmergencyOff ||
         mode == control::Mode::kFault;
}

/// Runs until interrupted; then lets the leg down by damping and leaves with the drives off.
void run(app::ControlLoop& loop, hoof::hal::SocketCanBus& bus0, const hoof::hal::Clock& clock) {
  while (!interrupted) {
    bus0.wait(kLongestSleep_ns);
    loop.poll();
  }
  loop.request_stop();
  const std::int64_t give_up_ns = clock.now_ns() + kLongestStop_ns;
  while (!drives_off(loop.mode()) && clock.now_ns() < give_up_ns) {
    bus0.wait(kLongestSleep_ns);
    loop.poll();
  }
  loop.release_drives();
}

/// Only what the dictionary says is for the foot on that bus: with one interface for both buses the
/// two connections must not see each other's frames.
hoof::hal::SocketCanSettings connection(const std::string& interface, std::size_t bus_index) {
  hoof::hal::SocketCanSettings settings;
  settings.interface = interface;
  settings.stamps = false;  // the loop goes by when it reads a frame
  app::for_each_received_id(bus_index, [&settings](std::uint32_t id) {
    settings.filters.push_back({.id = id, .mask = 0x7FF});
  });
  return settings;
}

void say_stopped(const app::ControlLoop& loop, std::uint64_t lost_frames) {
  std::cerr << "hoof-firmware: stopped after " << loop.telemetry().counters.ticks
            << " ticks, drives off; " << lost_frames << " frames lost by the kernel\n";
}

int start(const board::Options& options) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  std::optional<hoof::hal::FileFlash> flash;
  std::optional<app::Storage> storage;
  app::Parameters parameters;
  if (!options.flash.empty()) {
    flash.emplace(options.flash, kFlashSectors, kFlashSectorWords);
    storage.emplace(*flash).load(parameters);
  }
  board::apply_settings(options, parameters);
  app::Storage* const kept = storage ? &*storage : nullptr;
  if (options.lock_step) {
    board::LockStepFoot foot(options, parameters, kept);
    foot.run(interrupted);
    say_stopped(foot.loop(), foot.dropped());
    return 0;
  }
  hoof::hal::SocketCanBus bus0(connection(options.bus0, 0));
  hoof::hal::SocketCanBus bus1(connection(options.bus1, 1));
  const board::ScaledClock clock(options.slow_down);
  hoof::hal::SoftBoard board;
  app::ControlLoop loop({&bus0, &bus1}, clock, board, parameters, kept);
  run(loop, bus0, clock);
  say_stopped(loop, bus0.status().dropped + bus1.status().dropped);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const board::Options options = board::read_options(argc, argv);
    if (options.help.empty()) return start(options);
    std::cout << options.help;
    return 0;
  } catch (const CLI::ParseError& error) {
    std::cerr << "hoof-firmware: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "hoof-firmware: " << error.what() << '\n';
    return 1;
  }
}
