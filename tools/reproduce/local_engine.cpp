#include "tools/reproduce/local_engine.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iostream>
#include <map>
#include <thread>

#include "tools/reproduce/worker.h"
#include "tools/run/errors.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"

extern char** environ;

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

using Told = std::function<void(const std::string& id)>;

/// Says which run begins and how long the rest may take.
class Account {
 public:
  Account(std::size_t runs, bool quiet) : runs_(runs), quiet_(quiet) {}

  void begins(const std::string& id) {
    ++begun_;
    if (quiet_) return;
    const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start_;
    std::string left;
    if (ended_ > 0) {
      const double left_s = gone.count() / double(ended_) * double(runs_ - ended_);
      left = ", about " + format_duration(left_s) + " left";
    }
    std::cerr << "run " << begun_ << " of " << runs_ << left << ": " << id << std::endl;
  }
  void ends() { ++ended_; }
  void failed(const std::string& why) { std::cerr << "hoof: " << why << "\n"; }

 private:
  std::size_t runs_, begun_ = 0, ended_ = 0;
  bool quiet_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<std::string> run_in_turn(const RunStore& store, const std::vector<PlannedRun>& missing,
                                     bool quiet, const Told& after) {
  std::vector<std::string> failed;
  Account account(missing.size(), quiet);
  for (const PlannedRun& run : missing) {
    account.begins(run.id);
    const std::string why_not = make_once(store, run, quiet);
    account.ends();
    if (why_not.empty()) {
      after(run.id);
    } else {
      failed.push_back(run.id + ": " + why_not);
      account.failed(failed.back());
    }
  }
  return failed;
}

/// Some at once. What they print goes to DIR/log/ID.txt.
class AtOnce {
 public:
  AtOnce(const RunStore& store, const std::vector<PlannedRun>& missing, int jobs, bool quiet,
         const Told& after)
      : store_(store),
        waiting_(missing.begin(), missing.end()),
        jobs_(jobs),
        after_(after),
        account_(missing.size(), quiet) {
    fs::create_directories(store.folder() / "log");
  }

  std::vector<std::string> go() {
    while (!waiting_.empty() || !running_.empty()) {
      while (!stop_.requested() && running_.size() < std::size_t(jobs_) && start_next()) {
      }
      if (stop_.requested()) {
        tell_to_stop();
        if (running_.empty()) break;
      }
      if (!reap()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (stop_.requested()) {
      throw Interrupted(
          "stopped; what is finished is kept, and the same command goes on from there",
          stop_.exit_status());
    }
    return failed_;
  }

 private:
  struct Running {
    PlannedRun run;
    fs::path bed_in_making;  // that it makes first; empty: it was there
  };

  /// The first whose bed nobody else is making.
  bool start_next() {
    for (auto run = waiting_.begin(); run != waiting_.end(); ++run) {
      const BedPlace bed = bed_place(*run);
      const fs::path making = bed.there ? fs::path() : bed.file;
      const bool taken =
          !making.empty() && std::any_of(running_.begin(), running_.end(), [&](const auto& other) {
            return other.second.bed_in_making == making;
          });
      if (taken) continue;
      account_.begins(run->id);
      running_[spawn(run->id)] = {*run, making};
      waiting_.erase(run);
      return true;
    }
    return false;
  }

  pid_t spawn(const std::string& id) {
    std::vector<std::string> words = {"hoof", "campaign", "run",      store_.folder().string(),
                                      id,     "--quiet",  "--parent", std::to_string(getpid())};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string log = (store_.folder() / "log" / (id + ".txt")).string();
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    // In our group: Ctrl-C in a terminal reaches them as it reaches us.
    pid_t child = 0;
    const int failure =
        posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) throw CannotFinish(std::string("cannot start hoof: ") + strerror(failure));
    return child;
  }

  void tell_to_stop() {
    if (told_) return;
    told_ = true;
    for (const auto& [child, running] : running_) kill(child, SIGTERM);
  }

  bool reap() {
    for (const auto& [child, running] : running_) {
      int status = 0;
      if (waitpid(child, &status, WNOHANG) != child) continue;
      const PlannedRun run = running.run;
      running_.erase(child);
      account_.ends();
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && store_.done(run)) {
        after_(run.id);
      } else if (!stop_.requested()) {
        failed_.push_back(run.id + ": " + reason(run.id, status));
        account_.failed(failed_.back());
      }
      return true;
    }
    return false;
  }

  std::string reason(const std::string& id, int status) const {
    const auto attempt = store_.attempt(id);
    if (attempt && !attempt->why.empty()) return attempt->why;
    const std::string log = (store_.folder() / "log" / (id + ".txt")).string();
    if (WIFSIGNALED(status)) return "ended by signal " + std::to_string(WTERMSIG(status));
    return "exit status " + std::to_string(WEXITSTATUS(status)) + ", see " + log;
  }

  const RunStore& store_;
  std::vector<PlannedRun> waiting_;
  int jobs_;
  const Told& after_;
  Account account_;
  StopRequest stop_;
  bool told_ = false;
  std::map<pid_t, Running> running_;
  std::vector<std::string> failed_;
};

}  // namespace

std::vector<std::string> LocalEngine::run(const RunStore& store,
                                          const std::vector<PlannedRun>& missing,
                                          const Told& after) const {
  if (jobs <= 1 || missing.size() < 2) return run_in_turn(store, missing, quiet, after);
  return AtOnce(store, missing, jobs, quiet, after).go();
}

}  // namespace hoof::tools
