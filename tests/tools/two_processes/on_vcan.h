// What the tests of two processes on vcan0 share.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "firmware/protocol/codec.h"
#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "hil_bridge/candump.h"
#include "tests/tools/experiment/program.h"

namespace hoof::tests {

namespace fs = std::filesystem;
namespace protocol = firmware::protocol;
using namespace std::chrono_literals;

using Arguments = std::vector<std::string>;

/// On a hard floor and let down fast: a third of a second of simulated time.
inline Arguments short_run(const std::string& kind, const fs::path& out, const Arguments& more) {
  Arguments all = {kind, "--terrain", "rigid", "--quiet", "--out", out.string()};
  if (kind == "sinkage") {
    for (const char* setting : {"experiment.start_height_mm=12", "experiment.toe_deg=5"}) {
      all.insert(all.end(), {"--set", setting});
    }
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

inline const Arguments kOnVcan = {"--bus", "vcan0"};

/// Processes of that name whose parent is `parent`; 0 for any parent.
inline std::vector<pid_t> processes(const std::string& name, pid_t parent) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string id = entry.path().filename().string();
    if (!std::all_of(id.begin(), id.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
    std::ifstream stat(entry.path() / "stat");
    std::string number, command, state;
    pid_t its_parent = 0;
    stat >> number >> command >> state >> its_parent;
    if (command != "(" + name + ")" || state == "Z") continue;
    if (parent == 0 || its_parent == parent) found.push_back(pid_t(std::stol(id)));
  }
  return found;
}

inline void require_nothing_left() {
  CHECK(processes("hoof-firmware", 0).empty());
  CHECK(processes("hoof-bridge", 0).empty());
}

/// The child of `program` of that name.
inline pid_t wait_for_process(const std::string& name, const Program& program) {
  for (int i = 0; i < 2'000; ++i) {
    const auto found = processes(name, program.id());
    if (!found.empty()) return found.front();
    std::this_thread::sleep_for(5ms);
  }
  program.send(SIGKILL);
  const Outcome outcome = program.wait();
  FAIL(name << " was not started; status " << outcome.status << ": " << outcome.errors);
  return 0;
}

inline std::vector<bridge::CandumpRecord> read_bus_log(const fs::path& file) {
  std::ifstream input(file);
  REQUIRE(input);
  bridge::CandumpReader reader(input, file.string());
  std::vector<bridge::CandumpRecord> records;
  while (auto record = reader.next()) records.push_back(*record);
  return records;
}

inline nlohmann::json result_of(const fs::path& run) {
  return nlohmann::json::parse(tools::read_file(run / "result.json"));
}

/// Sleeps until SYNC of that tick is on the interface.
/// @return false where it does not come within 30 s
inline bool wait_for_tick(hal::SocketCanBus& listener, std::uint32_t tick) {
  const hal::MonotonicClock clock;
  const std::int64_t give_up_ns = clock.now_ns() + 30'000'000'000;
  hal::CanFrame frame;
  protocol::Sync sync;
  while (clock.now_ns() < give_up_ns) {
    listener.wait(1'000'000);
    while (listener.receive(frame)) {
      if (decode(frame, sync) == protocol::DecodeResult::kOk && sync.tick >= tick) return true;
    }
  }
  return false;
}

}  // namespace hoof::tests
