#include "tools/conceal/examination.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <iostream>
#include <map>
#include <thread>
#include <vector>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"

extern char** environ;

namespace hoof::tools::conceal {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<std::string> cases_in(const ExaminationOptions& options) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(options.batch, error)) {
    const std::string name = entry.path().filename().string();
    const bool asked = options.only.empty() || name == options.only;
    if (asked && fs::exists(entry.path() / "dataset.toml")) names.push_back(name);
  }
  if (error) throw UserError(options.batch.string() + ": " + error.message());
  if (names.empty()) {
    throw UserError(options.batch.string() + ": no " +
                    (options.only.empty() ? "case" : options.only) + " with a dataset.toml there");
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Programs at work, one a case; what they print goes to log.txt beside their answer.
class Examination {
 public:
  explicit Examination(const ExaminationOptions& options)
      : options_(options), progress_("diagnose", choose_progress_style(options.quiet), std::cerr) {}

  void run() {
    const std::vector<std::string> names = cases_in(options_);
    std::size_t next = 0, done = 0;
    while (done < names.size()) {
      while (next < names.size() && running_.size() < std::size_t(options_.jobs) &&
             !stop_.requested()) {
        const std::string& name = names[next++];
        if (fs::exists(options_.answers / name / "seconds.txt")) {
          ++done;
        } else {
          start(name);
        }
      }
      progress_.update(double(done) / double(names.size()), detail());
      if (running_.empty() && (stop_.requested() || next >= names.size())) break;
      if (!reap(done)) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    progress_.finish();
    if (stop_.requested()) {
      throw Interrupted("stopped; answers are kept in " + options_.answers.string() +
                            " and the same command goes on from there",
                        stop_.exit_status());
    }
    if (!failed_.empty()) throw CannotFinish(options_.program + " diagnose failed: " + failed_);
  }

 private:
  struct Running {
    std::string name;
    Clock::time_point since;
  };

  std::string detail() const { return running_.empty() ? "" : running_.begin()->second.name; }

  void start(const std::string& name) {
    const fs::path answer = options_.answers / name;
    std::error_code error;
    fs::create_directories(answer, error);
    if (error) throw UserError(answer.string() + ": " + error.message());
    std::vector<std::string> words = {options_.program, "diagnose",
                                      (options_.batch / name / "dataset.toml").string()};
    const fs::path beside = options_.batch / name / "rigid.toml";
    if (fs::exists(beside)) words.push_back(beside.string());
    words.insert(words.end(), {"--out", answer.string()});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    const std::string log = (answer / "log.txt").string();
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    // A group of its own: Ctrl-C in a terminal lets it finish its case.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t id = 0;
    const int failure = posix_spawnp(&id, options_.program.c_str(), &actions, &attributes,
                                     arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failure != 0) throw UserError(options_.program + ": " + std::strerror(failure));
    running_[id] = {name, Clock::now()};
  }

  /// Takes in one that has ended, if any has.
  bool reap(std::size_t& done) {
    for (const auto& [id, one] : running_) {
      int status = 0;
      if (waitpid(id, &status, WNOHANG) != id) continue;
      const fs::path answer = options_.answers / one.name;
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && fs::exists(answer / "verdict.json")) {
        write_file(answer / "seconds.txt", std::to_string(seconds_since(one.since)) + "\n");
      } else {
        failed_ += (failed_.empty() ? "" : ", ") + one.name;
      }
      ++done;
      running_.erase(id);
      return true;
    }
    return false;
  }

  const ExaminationOptions& options_;
  ProgressLine progress_;
  StopRequest stop_;
  std::map<pid_t, Running> running_;
  std::string failed_;
};

}  // namespace

void examine(const ExaminationOptions& options) {
  Examination(options).run();
}

}  // namespace hoof::tools::conceal
