// hoof-firmware and hoof-bridge over a real vcan0, as a user starts them. Runs where vcan0 is: see
// tests/hal/socketcan/run_where_vcan_is.sh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <thread>

#include "firmware/protocol/codec.h"
#include "hal/monotonic_clock.h"
#include "hal/socketcan/socketcan_bus.h"
#include "hil_bridge/candump.h"
#include "tests/tools/experiment/program.h"

using namespace hoof;
using namespace std::chrono_literals;
namespace fs = std::filesystem;
namespace protocol = firmware::protocol;
using tests::Outcome;
using tests::Program;

namespace {

using Arguments = std::vector<std::string>;

/// On a hard floor and let down fast: a third of a second of simulated time.
Arguments short_run(const std::string& kind, const fs::path& out, const Arguments& more) {
  Arguments all = {kind, "--terrain", "rigid", "--quiet", "--out", out.string()};
  if (kind == "sinkage") {
    for (const char* setting : {"experiment.start_height_mm=12", "experiment.toe_deg=5"}) {
      all.insert(all.end(), {"--set", setting});
    }
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const Arguments kOnVcan = {"--bus", "vcan0"};

/// Processes of that name whose parent is `parent`; 0 for any parent.
std::vector<pid_t> processes(const std::string& name, pid_t parent) {
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

void require_nothing_left() {
  CHECK(processes("hoof-firmware", 0).empty());
  CHECK(processes("hoof-bridge", 0).empty());
}

pid_t wait_for_process(const std::string& name, pid_t parent) {
  for (int i = 0; i < 2'000; ++i) {
    const auto found = processes(name, parent);
    if (!found.empty()) return found.front();
    std::this_thread::sleep_for(5ms);
  }
  FAIL(name << " was not started");
  return 0;
}

std::vector<bridge::CandumpRecord> read_bus_log(const fs::path& file) {
  std::ifstream input(file);
  REQUIRE(input);
  bridge::CandumpReader reader(input, file.string());
  std::vector<bridge::CandumpRecord> records;
  while (auto record = reader.next()) records.push_back(*record);
  return records;
}

/// Whole events of an LCM log that may end anywhere.
int lcm_events(const fs::path& file) {
  lcm::LogFile log(file.string(), "r");
  REQUIRE(log.good());
  int events = 0;
  while (log.readNextEvent() != nullptr) ++events;
  return events;
}

/// The hidden folder in which a killed run was growing.
fs::path abandoned_folder(const fs::path& parent) {
  for (const auto& entry : fs::directory_iterator(parent)) {
    if (entry.path().filename().string().starts_with(".") && fs::is_directory(entry)) {
      return entry.path();
    }
  }
  return {};
}

nlohmann::json result_of(const fs::path& run) {
  return nlohmann::json::parse(tools::read_file(run / "result.json"));
}

/// Sleeps until SYNC of that tick is on the interface.
/// @return false where it does not come within 30 s
bool wait_for_tick(hal::SocketCanBus& listener, std::uint32_t tick) {
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

/// Shorter than the shortest run here, so that what is killed there is killed in the run.
constexpr std::uint32_t kTicksOfARun = 300;

int repetitions() {
  return std::getenv("HOOF_FULL_TESTS") != nullptr ? 100 : 3;
}

}  // namespace

TEST_CASE("lock-step over vcan0 writes the bus.log of the run in one process, byte for byte") {
  const auto kind = GENERATE(as<std::string>{}, "sinkage", "traction");
  CAPTURE(kind);
  const tests::ScratchFolder scratch;
  const fs::path here = scratch.path() / "here", there = scratch.path() / "there";
  const Outcome one = tests::run_program(short_run(kind, here, {}));
  REQUIRE(one.status == 0);
  const Outcome two = tests::run_program(short_run(kind, there, kOnVcan));
  CAPTURE(two.errors, two.output);
  REQUIRE(two.status == 0);
  const std::string log = tools::read_file(here / "bus.log");
  REQUIRE(std::count(log.begin(), log.end(), '\n') > 1'000);
  CHECK((tools::read_file(there / "bus.log") == log));
  CHECK(result_of(there)["bus"]["frames_lost_by_kernel"] == 0);
  CHECK(result_of(there)["bus"]["clock"] == "lock-step");
  CHECK(result_of(there)["max_depth_m"] == result_of(here)["max_depth_m"]);
  require_nothing_left();
}

TEST_CASE("a firmware killed at a random tick: named, recorded, and the drives without torque") {
  std::random_device device;
  const unsigned seed = device();
  CAPTURE(seed);
  std::mt19937 random(seed);
  const std::regex message(
      "hoof-firmware on vcan0 did not answer SYNC ([0-9]+) within 300 ms; the drives were without "
      "torque ([0-9]+) ms after it");
  for (int i = 0; i < repetitions(); ++i) {
    const tests::ScratchFolder scratch;
    Arguments more = kOnVcan;
    more.insert(more.end(), {"--patience", "0.3"});
    const Program program(short_run("sinkage", scratch.path() / "run", more));
    hal::SocketCanBus listener(hal::SocketCanSettings{});
    const pid_t firmware = wait_for_process("hoof-firmware", program.id());
    const std::uint32_t tick = random() % kTicksOfARun;
    REQUIRE(wait_for_tick(listener, tick));
    kill(firmware, SIGKILL);
    const Outcome outcome = program.wait();
    require_nothing_left();
    CAPTURE(i, tick, outcome.errors);
    CHECK(outcome.status == 3);
    std::smatch found;
    REQUIRE(std::regex_search(outcome.errors, found, message));
    const auto unanswered = std::stoul(found[1]);
    CHECK(unanswered >= tick);
    CHECK(std::stoi(found[2]) <= 20);
    const fs::path kept = scratch.path() / "run-failed";
    const auto log = read_bus_log(kept / "bus.log");
    REQUIRE_FALSE(log.empty());
    protocol::Sync sync;
    std::uint32_t last = 0;
    for (const auto& record : log) {
      if (decode(record.frame, sync) == protocol::DecodeResult::kOk) last = sync.tick;
    }
    CHECK(last == unanswered + 40);  // the plant went on alone, so that time-outs could act
    CHECK(lcm_events(kept / "telemetry.lcm") > int(unanswered));
  }
}

TEST_CASE("a bridge killed at a random tick leaves a readable recording and no process") {
  std::random_device device;
  const unsigned seed = device();
  CAPTURE(seed);
  std::mt19937 random(seed);
  for (int i = 0; i < repetitions(); ++i) {
    const tests::ScratchFolder scratch;
    const fs::path out = scratch.path() / "run";
    const Program program(short_run("sinkage", out, kOnVcan));
    hal::SocketCanBus listener(hal::SocketCanSettings{});
    const pid_t bridge = wait_for_process("hoof-bridge", program.id());
    const std::uint32_t tick = random() % kTicksOfARun;
    REQUIRE(wait_for_tick(listener, tick));
    kill(bridge, SIGKILL);
    const Outcome outcome = program.wait();
    require_nothing_left();
    CAPTURE(i, tick, outcome.errors);
    CHECK(outcome.status == 3);
    CHECK(outcome.errors.find("hoof-bridge was ended by signal 9") != std::string::npos);
    CHECK(outcome.errors.find("drives off") != std::string::npos);  // the firmware's last word
    const fs::path left = abandoned_folder(scratch.path());
    REQUIRE(fs::exists(left / "bus.log"));
    const auto log = read_bus_log(left / "bus.log");
    protocol::Sync sync;
    std::int64_t last = -1;
    for (const auto& record : log) {
      if (decode(record.frame, sync) == protocol::DecodeResult::kOk) last = sync.tick;
    }
    CHECK(last >= std::int64_t(tick) - 12);  // all but its last 10 ms, as bus_log.h promises
    CHECK(lcm_events(left / "telemetry.lcm") >= int(tick) - 12);
    // Nothing is in the way of the next run.
    if (i == 0) CHECK(tests::run_program(short_run("sinkage", out, kOnVcan)).status == 0);
  }
}

TEST_CASE("Ctrl-C ends both in order and keeps what exists") {
  const tests::ScratchFolder scratch;
  const Program program(short_run("traction", scratch.path() / "run", kOnVcan));
  hal::SocketCanBus listener(hal::SocketCanSettings{});
  REQUIRE(wait_for_tick(listener, 100));
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  CAPTURE(outcome.errors);
  CHECK(outcome.status == 130);
  CHECK(fs::exists(scratch.path() / "run-interrupted" / "bus.log"));
  require_nothing_left();
}

TEST_CASE("hoof killed with -9 takes both with it") {
  const tests::ScratchFolder scratch;
  const Program program(short_run("traction", scratch.path() / "run", kOnVcan));
  hal::SocketCanBus listener(hal::SocketCanSettings{});
  REQUIRE(wait_for_tick(listener, 100));
  program.send(SIGKILL);
  program.wait();
  for (int i = 0;
       i < 400 && !(processes("hoof-firmware", 0).empty() && processes("hoof-bridge", 0).empty());
       ++i) {
    std::this_thread::sleep_for(20ms);
  }
  require_nothing_left();
}

TEST_CASE("a stranger's e-stop on the interface stops the foot and is in the recording") {
  const tests::ScratchFolder scratch;
  const Program program(short_run("traction", scratch.path() / "run", kOnVcan));
  hal::SocketCanBus button(hal::SocketCanSettings{});
  REQUIRE(wait_for_tick(button, 100));
  button.send(encode(protocol::EmergencyStop{9, 0}));
  const Outcome outcome = program.wait();
  CAPTURE(outcome.errors);
  CHECK(outcome.status == 3);
  CHECK(outcome.errors.find("emergency_stop") != std::string::npos);
  bool recorded = false;
  for (const auto& record : read_bus_log(scratch.path() / "run-failed" / "bus.log")) {
    recorded = recorded || record.frame.id == protocol::spec(protocol::Message::kEmergencyStop).id;
  }
  CHECK(recorded);
  require_nothing_left();
}

TEST_CASE("real time: the run comes to its end and tells how well its deadlines were kept") {
  const tests::ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  Arguments more = kOnVcan;
  more.insert(more.end(), {"--clock", "real-time"});
  const hal::MonotonicClock clock;
  const std::int64_t start_ns = clock.now_ns();
  const Outcome outcome = tests::run_program(short_run("sinkage", out, more));
  const double wall_s = double(clock.now_ns() - start_ns) * 1e-9;
  CAPTURE(outcome.errors, outcome.output);
  REQUIRE(outcome.status == 0);
  const nlohmann::json result = result_of(out);
  const nlohmann::json& real_time = result["bus"]["real_time"];
  CHECK(result["bus"]["clock"] == "real-time");
  const double ticks = real_time["ticks"];
  CHECK(ticks * 1e-3 <= wall_s);  // by the wall's clock, not faster
  std::uint64_t counted = 0;
  for (const auto& bin : real_time["wake_latency"]["histogram"]) {
    counted += bin["count"].get<std::uint64_t>();
  }
  CHECK(double(counted) == ticks - real_time["ticks_missed"].get<double>());
  for (const char* word : {"overruns", "wake latency: p50", "p99", "max", "wake jitter"}) {
    CHECK(outcome.output.find(word) != std::string::npos);
  }
  require_nothing_left();
}

TEST_CASE("what cannot be done is said in one line") {
  const tests::ScratchFolder scratch;
  const std::string out = (scratch.path() / "run").string();
  SECTION("grains in real time") {
    const Outcome outcome =
        tests::run_program({"sinkage", "--bus", "vcan0", "--clock", "real-time", "--out", out});
    CHECK(outcome.status == 2);
    CHECK(outcome.errors.find("add --terrain rigid") != std::string::npos);
  }
  SECTION("real time without a bus") {
    const Outcome outcome =
        tests::run_program({"sinkage", "--clock", "real-time", "--terrain", "rigid", "--out", out});
    CHECK(outcome.status == 2);
    CHECK(outcome.errors.find("--bus vcan0") != std::string::npos);
  }
  SECTION("an interface that is not there") {
    const Outcome outcome =
        tests::run_program({"sinkage", "--bus", "nocan7", "--terrain", "rigid", "--out", out});
    CHECK(outcome.status == 3);
    CHECK(outcome.errors.find("nocan7") != std::string::npos);
  }
  CHECK_FALSE(fs::exists(out));
  require_nothing_left();
}
