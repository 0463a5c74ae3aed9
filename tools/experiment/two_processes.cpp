#include "tools/experiment/two_processes.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <thread>

#include "hil_bridge/remote_line.h"
#include "tools/run/errors.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

using namespace std::chrono_literals;

/// A foot tells that it is there ten times a second.
constexpr std::int64_t kHeartbeats_ns = 250'000'000;
/// The firmware lets a loaded leg down for up to 2 s before it ends.
constexpr auto kLongestEnd = 5s;

/// Where the build puts them: beside this program, or in their own folder of the build.
std::filesystem::path find_program(const std::string& name) {
  const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  for (const auto& folder : {here, here / "../../firmware/board/host", here / "../../tools/cli"}) {
    if (std::filesystem::exists(folder / name)) {
      return std::filesystem::weakly_canonical(folder / name);
    }
  }
  throw CannotFinish(name + " is not there; `ninja -C " +
                     std::filesystem::weakly_canonical(here / "../..").string() + " " + name +
                     "` builds it");
}

class Child {
 public:
  Child(const std::string& name, std::vector<std::string> arguments) : name_(name) {
    arguments.insert(arguments.begin(), find_program(name).string());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t parent = getpid();
    id_ = fork();
    if (id_ < 0) throw CannotFinish("cannot start " + name + ": " + std::strerror(errno));
    if (id_ > 0) return;
    // A group of its own: Ctrl-C of the terminal comes to the parent alone, which knows the order.
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);
    execv(argv[0], argv.data());
    _exit(127);
  }

  /// Nothing outlives the run.
  ~Child() {
    if (ended()) return;
    signal(SIGTERM);
    const auto give_up = std::chrono::steady_clock::now() + kLongestEnd;
    while (!ended() && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(5ms);
    }
    if (ended()) return;
    signal(SIGKILL);
    waitpid(id_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void signal(int number) const {
    if (!status_) kill(id_, number);
  }

  bool ended() {
    int status = 0;
    if (!status_ && waitpid(id_, &status, WNOHANG) == id_) status_ = status;
    return status_.has_value();
  }

  /// Once it has ended.
  bool killed() const { return WIFSIGNALED(*status_); }
  int exit_status() const { return WEXITSTATUS(*status_); }
  std::string end() const {
    return name_ + (killed() ? " was ended by signal " + std::to_string(WTERMSIG(*status_))
                             : " ended with status " + std::to_string(exit_status()));
  }

 private:
  std::string name_;
  pid_t id_ = -1;
  std::optional<int> status_;
};

bool foot_is_there(const std::string& bus) {
  bridge::RemoteLine line(bus);
  return line.hears_foot(kHeartbeats_ns);
}

std::vector<std::string> with_bus(const std::string& bus, const std::vector<std::string>& rest) {
  std::vector<std::string> all = {"--bus", bus};
  all.insert(all.end(), rest.begin(), rest.end());
  return all;
}

}  // namespace

void run_two_processes(const TwoProcesses& what) {
  if (foot_is_there(what.bus)) {
    throw UserError("--bus " + what.bus + ": a foot is on this bus already; hoof-bridge --bus " +
                    what.bus + " runs the plant for it");
  }
  const StopRequest stop;
  Child firmware("hoof-firmware", with_bus(what.bus, what.firmware_options));
  Child bridge("hoof-bridge", with_bus(what.bus, what.bridge_options));
  bool told_stop = false, told_death = false;
  while (!bridge.ended()) {
    if (stop.requested() && !told_stop) {
      bridge.signal(SIGINT);
      told_stop = true;
    }
    if (!told_death && firmware.ended()) {
      std::cerr << "hoof: " << firmware.end() << std::endl;
      told_death = true;
    }
    std::this_thread::sleep_for(5ms);
  }
  if (bridge.killed()) throw CannotFinish(bridge.end());
  if (bridge.exit_status() != 0) throw AlreadySaid(bridge.exit_status());
}

}  // namespace hoof::tools
