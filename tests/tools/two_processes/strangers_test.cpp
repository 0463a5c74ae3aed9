// Nodes that have no business on vcan0, beside a foot in another process: no joint moves for them.
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "tests/tools/two_processes/on_vcan.h"

using namespace hoof;
using namespace hoof::tests;

namespace {

/// A program beside the test, ended with it.
class Beside {
 public:
  explicit Beside(std::vector<std::string> command) {
    std::vector<char*> argv;
    for (std::string& word : command) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ != 0) return;
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDOUT_FILENO), dup2(nothing, STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
  }
  ~Beside() { end(SIGTERM); }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  bool running() {
    if (child_ < 0) return false;
    siginfo_t info{};
    waitid(P_PID, id_t(child_), &info, WEXITED | WNOHANG | WNOWAIT);
    return info.si_pid == 0;
  }

  /// @return exit status, or -signal
  int end(int signal_number) {
    if (child_ < 0) return status_;
    if (signal_number != 0) kill(child_, signal_number);
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return status_;
  }

 private:
  pid_t child_ = -1;
  int status_ = 0;
};

/// hoof-firmware in mode off, by its own clock, with nobody's plant.
struct LoneFoot {
  ScratchFolder scratch;
  hal::SocketCanBus ear{hal::SocketCanSettings{}};
  Beside firmware{{HOOF_FIRMWARE, "--bus", "vcan0", "--flash", scratch.path() / "flash"}};

  LoneFoot() {
    protocol::Heartbeat heartbeat;
    REQUIRE(hears([&](const hal::CanFrame& frame) {
      return decode(frame, heartbeat) == protocol::DecodeResult::kOk;
    }));
  }

  /// Listens for at most 5 s. @return true once `wanted` says so
  bool hears(const std::function<bool(const hal::CanFrame&)>& wanted) {
    const hal::MonotonicClock clock;
    const std::int64_t give_up_ns = clock.now_ns() + 5'000'000'000;
    hal::CanFrame frame;
    while (clock.now_ns() < give_up_ns) {
      ear.wait(1'000'000);
      while (ear.receive(frame)) {
        note(frame);
        if (wanted(frame)) return true;
      }
    }
    return false;
  }

  void note(const hal::CanFrame& frame) {
    for (const protocol::Drive drive : protocol::kDrives) {
      protocol::DriveOrder order;
      if (decode_command(drive, frame, order) != protocol::DecodeResult::kOk) continue;
      ++commands;
      if (order.action != protocol::DriveSwitch::kExit) ++pushing;
    }
    protocol::OrderAcknowledge answer;
    if (decode(frame, answer) == protocol::DecodeResult::kOk) results.insert(answer.result);
    protocol::Heartbeat heartbeat;
    if (decode(frame, heartbeat) == protocol::DecodeResult::kOk) mode = heartbeat.mode;
  }

  /// Notes all that is said while another program talks.
  void listen_beside(Beside& talker) {
    hal::CanFrame frame;
    while (talker.running()) {
      ear.wait(5'000'000);
      while (ear.receive(frame)) note(frame);
    }
    CHECK(talker.end(0) == 0);
  }

  /// Lets what is under way arrive, and one heartbeat more.
  void settle() {
    int heartbeats = 0;
    REQUIRE(hears([&](const hal::CanFrame& frame) {
      protocol::Heartbeat heartbeat;
      return decode(frame, heartbeat) == protocol::DecodeResult::kOk && ++heartbeats == 3;
    }));
  }

  int commands = 0;  // to drives
  int pushing = 0;   // those of them that are not "exit"
  std::set<protocol::OrderResult> results;
  protocol::Mode mode = protocol::Mode::kOff;
};

/// Commands of each drive in the order of a recording: position and torque, or nothing for a
/// switch.
std::map<int, std::vector<double>> positions(const fs::path& bus_log) {
  std::map<int, std::vector<double>> all;
  for (const auto& record : read_bus_log(bus_log)) {
    for (const protocol::Drive drive : protocol::kDrives) {
      protocol::DriveOrder order;
      if (decode_command(drive, record.frame, order) != protocol::DecodeResult::kOk) continue;
      if (!order.action) all[int(drive)].push_back(double(order.command.position_rad));
    }
  }
  return all;
}

/// An encoder's step on the wire is 0.4 mrad; frames that arrive a little later, because the wire
/// was taken, may change one.
constexpr double kStill_rad = 0.8e-3;

}  // namespace

TEST_CASE("a foot in mode off: floods, FD frames and a second master switch no drive on") {
  LoneFoot foot;
  SECTION("cangen at full rate, anything but the e-stop's identifier") {
    // Every identifier above the dictionary's, and extended ones, with random data and length.
    Beside extended({"cangen", "vcan0", "-g", "0", "-i", "-e", "-n", "6000"});
    Beside standard({"cangen", "vcan0", "-g", "0", "-i", "-I", "7FF", "-n", "6000"});
    foot.listen_beside(extended);
    foot.listen_beside(standard);
  }
  SECTION("random data under the orders' and SYNC's own identifiers") {
    for (const char* id : {"010", "040", "042", "043", "044"}) {
      Beside cangen({"cangen", "vcan0", "-g", "0", "-i", "-I", id, "-n", "3000"});
      foot.listen_beside(cangen);
    }
  }
  SECTION("CAN FD frames on classic nodes") {
    for (const char* id : {"010", "021", "040", "042"}) {
      Beside cangen({"cangen", "vcan0", "-f", "-b", "-g", "0", "-i", "-I", id, "-n", "2000"});
      foot.listen_beside(cangen);
    }
  }
  SECTION("a second master gives the beat and orders without having connected") {
    hal::SocketCanBus master(hal::SocketCanSettings{});
    hal::CanFrame frame;
    // On a crowded machine the foot misses beats: until it has followed enough of them.
    constexpr int kFollowed = 300;
    for (std::uint32_t tick = 0; tick < 20'000 && foot.commands <= kFollowed; ++tick) {
      master.send(encode(protocol::Sync{tick}));
      if (tick % 20 == 10) {
        master.send(encode(protocol::SupervisorOrder{7, protocol::Order::kReady, 0.2f, 0.0f,
                                                     std::uint8_t(tick / 20)}));
      }
      std::this_thread::sleep_for(1ms);
      while (foot.ear.receive(frame)) foot.note(frame);
    }
    foot.settle();
    CHECK(foot.commands > kFollowed);  // it follows the beat, and tells its drives to stay off
    CHECK(foot.results.count(protocol::OrderResult::kNotConnected) == 1);
    CHECK(foot.results.count(protocol::OrderResult::kAccepted) == 0);
  }
  foot.settle();
  CHECK(foot.ear.status().dropped == 0);  // nothing was said unheard
  CHECK(foot.pushing == 0);
  // Without torque. A busy machine may interrupt a tick for a millisecond, which is a fault.
  CHECK((foot.mode == protocol::Mode::kOff || foot.mode == protocol::Mode::kFault));
  CHECK(foot.firmware.end(SIGTERM) == 0);
}

TEST_CASE("a run beside strangers moves its joints as one without them") {
  const ScratchFolder scratch;
  const fs::path alone = scratch.path() / "alone", beside = scratch.path() / "beside";
  REQUIRE(run_program(short_run("traction", alone, kOnVcan)).status == 0);
  {
    Beside fd({"cangen", "vcan0", "-f", "-g", "3", "-i", "-I", "040"});
    const Program program(short_run("traction", beside, kOnVcan));
    hal::SocketCanBus master(hal::SocketCanSettings{});
    REQUIRE(wait_for_tick(master, 100));
    // As many as take a part of the run at full rate, or this takes half a minute.
    Beside flood({"cangen", "vcan0", "-g", "0", "-i", "-I", "7FF", "-L", "8", "-n", "15000"});
    for (std::uint8_t i = 0; i < 20; ++i) {
      master.send(encode(protocol::SupervisorOrder{9, protocol::Order::kRun, 0.3f, 2.0f, i}));
      master.send(encode(protocol::SupervisorOrder{9, protocol::Order::kReset, 0.0f, 0.0f, i}));
      std::this_thread::sleep_for(2ms);
    }
    const Outcome outcome = program.wait();
    CAPTURE(outcome.errors, outcome.output);
    REQUIRE(outcome.status == 0);
  }
  int strange = 0;
  for (const auto& record : read_bus_log(beside / "bus.log")) strange += record.frame.id == 0x7FF;
  CHECK(strange > 20);  // they were heard; how many came in time is the machine's to say
  auto without = positions(alone / "bus.log"), with = positions(beside / "bus.log");
  REQUIRE(with.size() == without.size());
  for (auto& [drive, expected] : without) {
    CAPTURE(drive, expected.size(), with[drive].size());
    // Homing and orders may take a tick more where the wire was taken.
    REQUIRE(std::abs(double(expected.size()) - double(with[drive].size())) < 60);
    const auto [low, high] = std::minmax_element(expected.begin(), expected.end());
    const auto [its_low, its_high] = std::minmax_element(with[drive].begin(), with[drive].end());
    CHECK(std::abs(*its_low - *low) < kStill_rad);
    CHECK(std::abs(*its_high - *high) < kStill_rad);
  }
  require_nothing_left();
}

TEST_CASE("hoof param and hoof faults speak with a running hoof-firmware") {
  LoneFoot foot;
  const auto hoof = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--bus", "vcan0"});
    return run_program(arguments);
  };
  const Outcome set = hoof({"param", "set", "toe_kp_Nm_rad=123", "--store"});
  CAPTURE(set.errors, set.output);
  CHECK(set.status == 0);
  CHECK(set.output.find("stored") != std::string::npos);
  const Outcome get = hoof({"param", "get", "toe_kp_Nm_rad"});
  CHECK(get.status == 0);
  CHECK(get.output.find("123") != std::string::npos);
  const Outcome wrong = hoof({"param", "set", "toe_kp_Nm_rad=1e9"});
  CAPTURE(wrong.errors);
  CHECK(wrong.status == 2);
  CHECK(wrong.errors.find("toe_kp_Nm_rad") != std::string::npos);

  // The e-stop is a fault that the log keeps.
  hal::SocketCanBus button(hal::SocketCanSettings{});
  button.send(encode(protocol::EmergencyStop{9, 0}));
  std::this_thread::sleep_for(300ms);
  const Outcome faults = hoof({"faults"});
  CAPTURE(faults.errors, faults.output);
  CHECK(faults.status == 0);
  CHECK(faults.output.find("emergency_stop") != std::string::npos);
  const Outcome refused = hoof({"faults", "--erase"});  // in mode off only
  CHECK(refused.status == 3);
  CHECK(refused.errors.find("wrong_mode") != std::string::npos);
  const Outcome reset = hoof({"command", "reset"});
  CAPTURE(reset.errors, reset.output);
  CHECK(reset.status == 0);
  const Outcome erased = hoof({"faults", "--erase"});
  CAPTURE(erased.errors, erased.output);
  CHECK(erased.status == 0);
  CHECK(hoof({"faults"}).output.find("emergency_stop") == std::string::npos);

  // What was stored is there after a restart.
  CHECK(foot.firmware.end(SIGTERM) == 0);
  const Beside again({HOOF_FIRMWARE, "--bus", "vcan0", "--flash", foot.scratch.path() / "flash"});
  CHECK(hoof({"param", "get", "toe_kp_Nm_rad"}).output.find("123") != std::string::npos);
}
