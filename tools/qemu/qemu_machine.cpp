#include "tools/qemu/qemu_machine.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/run/errors.h"

namespace hoof::tools::qemu {
namespace {

constexpr std::string_view kProgram = "qemu-system-arm";

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(std::string(kProgram) + ": " + what + ": " + std::strerror(errno));
}

OwnedFd memory_file(const char* name) {
  OwnedFd file(memfd_create(name, MFD_CLOEXEC));
  if (file.get() < 0) fail("no memory for a file");
  return file;
}

OwnedFd file_with(const std::vector<std::uint8_t>& bytes) {
  OwnedFd file = memory_file("flash");
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t n = write(file.get(), bytes.data() + written, bytes.size() - written);
    if (n < 0) fail("no memory for the flash");
    written += std::size_t(n);
  }
  return file;
}

std::vector<std::string> arguments(int flash, const std::array<int, QemuMachine::kLines>& lines) {
  std::ostringstream loader;
  loader << "loader,file=/proc/self/fd/" << flash << ",addr=0x" << std::hex
         << QemuMachine::kFlashStart << ",force-raw=on";
  // A reset that the image makes ends it: the simulator would wait for the old life's answer.
  std::vector<std::string> all = {"-M",      "netduinoplus2", "-nodefaults", "-display",
                                  "none",    "-monitor",      "none",        "-no-reboot",
                                  "-device", loader.str()};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string name = "usart" + std::to_string(i + 1);
    all.insert(all.end(), {"-chardev", "socket,id=" + name + ",fd=" + std::to_string(lines[i]),
                           "-serial", "chardev:" + name});
  }
  return all;
}

/// In the child, between fork and exec: system calls and nothing else.
[[noreturn]] void become(const char* program, char* const* argv, pid_t parent, int log,
                         std::initializer_list<int> kept) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  for (const int fd : kept) fcntl(fd, F_SETFD, 0);
  execv(program, argv);
  _exit(127);
}

}  // namespace

std::string find_qemu() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin" : path);
  std::string folder;
  while (std::getline(folders, folder, ':')) {
    const std::string program = folder + "/" + std::string(kProgram);
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  throw UserError(std::string(kProgram) +
                  " is not installed; it comes with Debian's package qemu-system-arm: apt-get "
                  "install qemu-system-arm");
}

OwnedFd& OwnedFd::operator=(OwnedFd&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

OwnedFd::~OwnedFd() {
  if (fd_ >= 0) close(fd_);
}

QemuMachine::QemuMachine(const std::vector<std::uint8_t>& flash) : log_(memory_file("log")) {
  const std::string program = find_qemu();
  const OwnedFd flash_file = file_with(flash);
  std::array<OwnedFd, kLines> theirs;
  for (std::size_t i = 0; i < kLines; ++i) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) fail("no serial line");
    lines_[i] = OwnedFd(ends[0]);
    theirs[i] = OwnedFd(ends[1]);
    if (fcntl(ends[0], F_SETFL, O_NONBLOCK) != 0) fail("no serial line");
  }
  std::vector<std::string> all = arguments(flash_file.get(), {theirs[0].get(), theirs[1].get()});
  all.insert(all.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t parent = getpid();
  id_ = fork();
  if (id_ < 0) fail("cannot be started");
  if (id_ == 0) {
    become(program.c_str(), argv.data(), parent, log_.get(),
           {flash_file.get(), theirs[0].get(), theirs[1].get()});
  }
}

QemuMachine::~QemuMachine() {
  if (status_) return;
  kill(id_, SIGKILL);  // it has no file of ours
  while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::string QemuMachine::ended() {
  int status = 0;
  if (!status_ && waitpid(id_, &status, WNOHANG) == id_) status_ = status;
  if (!status_) return {};
  const std::string words = said();
  if (WIFEXITED(*status_) && WEXITSTATUS(*status_) == 0 && words.empty()) {
    return "the image has reset itself, as it does after a fault";
  }
  const std::string how = WIFSIGNALED(*status_)
                              ? "was ended by signal " + std::to_string(WTERMSIG(*status_))
                              : "ended with status " + std::to_string(WEXITSTATUS(*status_));
  return std::string(kProgram) + " " + how + (words.empty() ? "" : ": " + words);
}

/// The first line of it.
std::string QemuMachine::said() const {
  char text[400];
  const ssize_t n = pread(log_.get(), text, sizeof text, 0);
  const std::string_view all(text, n > 0 ? std::size_t(n) : 0);
  return std::string(all.substr(0, all.find('\n')));
}

}  // namespace hoof::tools::qemu
