// The program itself as a child process: what it prints, how it ends, and signals to it.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

namespace hoof::tests {

struct Outcome {
  int status = 0;      ///< exit status; -signal where one ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// A run of the program that is under way. Its destructor waits for nobody: call wait().
class Program {
 public:
  /// @param file_limit_bytes longest file it may write, 0 for any
  explicit Program(std::vector<std::string> arguments, rlim_t file_limit_bytes = 0) {
    arguments.insert(arguments.begin(), HOOF_PROGRAM);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const std::string out = output_path().string(), err = errors_path().string();
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("cannot fork");
    if (child_ > 0) return;
    dup2(open(out.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), STDERR_FILENO);
    if (file_limit_bytes > 0) {
      const rlimit limit{file_limit_bytes, file_limit_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
      signal(SIGXFSZ, SIG_IGN);  // write() then fails with EFBIG
    }
    execv(argv[0], argv.data());
    _exit(127);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void send(int signal_number) const { kill(child_, signal_number); }
  pid_t id() const { return child_; }

  Outcome wait() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status),
            tools::read_file(output_path()), tools::read_file(errors_path())};
  }

 private:
  std::filesystem::path output_path() const { return scratch_.path() / "out"; }
  std::filesystem::path errors_path() const { return scratch_.path() / "err"; }

  ScratchFolder scratch_;
  pid_t child_ = -1;
};

inline Outcome run_program(const std::vector<std::string>& arguments) {
  return Program(arguments).wait();
}

}  // namespace hoof::tests
