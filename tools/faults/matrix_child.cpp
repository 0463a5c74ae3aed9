#include "tools/faults/matrix_child.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace hoof::tools {
namespace {

std::runtime_error failed(const char* call) {
  return std::runtime_error(std::string(call) + ": " + std::strerror(errno));
}

int run(const std::function<bool(int)>& work, int pipe) {
  try {
    return work(pipe) ? 0 : 1;
  } catch (const std::exception& error) {
    const std::string text = std::string("hoof: ") + error.what() + "\n";
    return write(STDERR_FILENO, text.data(), text.size()) < 0 ? 2 : 1;
  }
}

}  // namespace

MatrixChild::MatrixChild(const std::function<bool(int)>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw failed("pipe");
  pid_ = fork();
  if (pid_ < 0) throw failed("fork");
  if (pid_ == 0) {
    close(ends[0]);
    _exit(run(work, ends[1]));
  }
  close(ends[1]);
  pipe_ = ends[0];
}

MatrixChild::MatrixChild(MatrixChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), pipe_(std::exchange(other.pipe_, -1)) {}

MatrixChild::~MatrixChild() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  close(pipe_);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

/// At once: all that is handed back fits the pipe's buffer.
bool MatrixChild::send(int pipe, std::span<const char> bytes) {
  return write(pipe, bytes.data(), bytes.size()) == ssize_t(bytes.size());
}

std::string MatrixChild::receive(std::span<char> bytes) {
  ssize_t got = 0;
  do {
    got = read(pipe_, bytes.data(), bytes.size());
  } while (got < 0 && errno == EINTR);
  close(pipe_);
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = pipe_ = -1;
  if (got == ssize_t(bytes.size())) return "";
  return WIFSIGNALED(status) ? "ended by signal " + std::to_string(WTERMSIG(status))
                             : "could not be run";
}

}  // namespace hoof::tools
