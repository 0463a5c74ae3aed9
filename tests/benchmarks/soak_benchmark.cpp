// Soak: hoof-firmware and the bridge's side of lock-step as two processes over a CAN interface, for
// a long time: no frame may be lost, no memory may grow. One JSON line every tenth of it.
//
// Lost frames are looked for three ways: the kernel's drop counters of the bridge (SO_RXQ_OVFL), of
// the firmware (which tells them at its end), and a third node that sees whether the SYNC numbers
// on the interface have a gap. Memory is the resident set of both processes; the first tenth, in
// which both come into their stride, is what it must not grow beyond.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>

#include "firmware/protocol/codec.h"
#include "hal/monotonic_clock.h"
#include "hil_bridge/bus_log.h"
#include "tests/benchmarks/lockstep_rigs.h"
#include "tests/benchmarks/remote_firmware.h"

namespace {

using namespace hoof;
using namespace hoof::benchmarks;
namespace protocol = firmware::protocol;

/// A page or two more is the allocator's; a leak of one frame's 88 bytes a tick would be megabytes.
constexpr long kGrowthLimit_KiB = 256;

long resident_KiB(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  long whole = 0, resident = 0;
  if (!(file >> whole >> resident)) throw std::runtime_error("a process has ended");
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

/// Counts the SYNC frames on the interface and the numbers that did not come.
class SyncWatch {
 public:
  explicit SyncWatch(const std::string& interface) : bus_(settings(interface)) {}

  void drain() {
    hal::CanFrame frame;
    protocol::Sync sync;
    while (bus_.receive(frame)) {
      ++frames_;
      if (decode(frame, sync) != protocol::DecodeResult::kOk) continue;
      if (last_ && sync.tick != *last_ + 1) missing_ += std::uint64_t(sync.tick - *last_ - 1);
      last_ = sync.tick;
    }
  }
  std::uint64_t frames() const { return frames_; }
  std::uint64_t missing() const { return missing_; }
  std::uint64_t dropped() const { return bus_.status().dropped; }

 private:
  static hal::SocketCanSettings settings(const std::string& interface) {
    hal::SocketCanSettings all;
    all.interface = interface;
    return all;
  }

  hal::SocketCanBus bus_;
  std::optional<std::uint32_t> last_;
  std::uint64_t frames_ = 0;
  std::uint64_t missing_ = 0;
};

/// @return frames that the firmware says were lost on the way to it
long lost_by_firmware(const std::filesystem::path& words) {
  std::stringstream text;
  text << std::ifstream(words).rdbuf();
  const std::string said = text.str();
  std::smatch found;
  if (!std::regex_search(said, found, std::regex("([0-9]+) frames lost by the kernel"))) {
    throw std::runtime_error("hoof-firmware did not end in order: " + said);
  }
  return std::stol(found[1]);
}

struct Memory {
  long bridge_KiB = 0;
  long firmware_KiB = 0;
};

class Soak {
 public:
  Soak(const std::string& interface, double seconds)
      : seconds_(seconds),
        words_(std::filesystem::temp_directory_path() /
               ("soak-" + std::to_string(getpid()) + ".txt")),
        run_(rigid_settings("traction")),
        firmware_(run_, interface, words_),
        watch_(interface) {}
  ~Soak() {
    std::error_code ignored;
    std::filesystem::remove(words_, ignored);
  }

  bool go() {
    const auto experiment = on_floor(run_);
    bridge::BusLogWriter log({"/dev/null"});
    const auto wires = bridge::in_process_wires(
        [&log](int bus, const hal::CanFrame& frame) { log.write(bus, frame); });
    {
      bridge::LockStep lock_step(*experiment, firmware_.maker(*wires), *wires);
      lock_step.supervisor().order(protocol::Order::kReady, 0.0);
      walk(lock_step);
    }
    std::uint64_t lost = firmware_.line().dropped();
    firmware_.end();
    watch_.drain();
    const long lost_there = lost_by_firmware(words_);
    const Memory grown = {now_.bridge_KiB - base_.bridge_KiB,
                          now_.firmware_KiB - base_.firmware_KiB};
    const bool ok = lost == 0 && lost_there == 0 && watch_.dropped() == 0 &&
                    watch_.missing() == 0 && grown.bridge_KiB <= kGrowthLimit_KiB &&
                    grown.firmware_KiB <= kGrowthLimit_KiB;
    std::printf(
        "{\"case\": \"soak\", \"ok\": %s, \"frames_on_interface\": %llu, "
        "\"lost_to_bridge\": %llu, \"lost_to_firmware\": %ld, \"lost_to_third_node\": %llu, "
        "\"sync_numbers_missing\": %llu, \"bridge_grew_KiB\": %ld, \"firmware_grew_KiB\": %ld, "
        "\"limit_KiB\": %ld}\n",
        ok ? "true" : "false", static_cast<unsigned long long>(watch_.frames()),
        static_cast<unsigned long long>(lost), lost_there,
        static_cast<unsigned long long>(watch_.dropped()),
        static_cast<unsigned long long>(watch_.missing()), grown.bridge_KiB, grown.firmware_KiB,
        kGrowthLimit_KiB);
    return ok;
  }

 private:
  void walk(bridge::LockStep& lock_step) {
    const hal::MonotonicClock clock;
    const std::int64_t start_ns = clock.now_ns();
    for (int tenth = 1; tenth <= 10; ++tenth) {
      const auto until_ns = start_ns + std::int64_t(seconds_ * 1e8 * tenth);
      while (clock.now_ns() < until_ns) {
        for (int i = 0; i < 50; ++i) lock_step.tick();
        watch_.drain();
        if (const auto& lost = lock_step.firmware().lost(); !lost.empty()) {
          throw std::runtime_error(lost);
        }
        if (const auto& why = lock_step.supervisor().trouble(); !why.empty()) {
          throw std::runtime_error(why);
        }
      }
      now_ = {resident_KiB(getpid()), resident_KiB(firmware_.id())};
      if (tenth == 1) base_ = now_;
      std::printf(
          "{\"seconds\": %.0f, \"ticks\": %u, \"frames_on_interface\": %llu, \"bridge_KiB\": %ld, "
          "\"firmware_KiB\": %ld}\n",
          double(clock.now_ns() - start_ns) * 1e-9, lock_step.ticks(),
          static_cast<unsigned long long>(watch_.frames()), now_.bridge_KiB, now_.firmware_KiB);
      std::fflush(stdout);
    }
  }

  double seconds_;
  std::filesystem::path words_;
  tools::RunSettings run_;
  RemoteFirmware firmware_;
  SyncWatch watch_;
  Memory base_, now_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Lock-step of two processes over a CAN interface for a long time: no frame lost, no memory "
      "grown");
  std::string interface = "vcan0";
  double seconds = 600;
  app.add_option("--bus", interface, "CAN interface")->capture_default_str();
  app.add_option("--seconds", seconds, "by the wall")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  app.footer("Example: tools/hoof benchmark soak --bus vcan0 --seconds 600");
  CLI11_PARSE(app, argc, argv);
  try {
    return Soak(interface, seconds).go() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
    return 1;
  }
}
