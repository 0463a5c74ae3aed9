// qemu-system-arm as a child process: a Netduino Plus 2 (STM32F405) with the image in its flash.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hoof::tools::qemu {

/// @throws UserError naming the Debian package where there is no qemu-system-arm
std::string find_qemu();

/// A file descriptor that is closed with its owner.
class OwnedFd {
 public:
  explicit OwnedFd(int fd = -1) : fd_(fd) {}
  OwnedFd(OwnedFd&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  OwnedFd& operator=(OwnedFd&& other) noexcept;
  ~OwnedFd();

  int get() const { return fd_; }

 private:
  int fd_;
};

/// Nothing outlives its owner: the child is killed with it, and by the kernel where the owner's
/// process ends in any other way. No files are made; Ctrl-C of a terminal does not reach the child.
class QemuMachine {
 public:
  static constexpr std::size_t kLines = 2;
  static constexpr std::uint32_t kFlashStart = 0x0800'0000;
  static constexpr std::size_t kFlashBytes = 1u << 20;

  /// @param flash what it holds, from its begin on; at most kFlashBytes
  /// @throws UserError as find_qemu(); std::runtime_error where a process cannot be made
  explicit QemuMachine(const std::vector<std::uint8_t>& flash);
  ~QemuMachine();
  QemuMachine(const QemuMachine&) = delete;
  QemuMachine& operator=(const QemuMachine&) = delete;

  /// The other end of USART1 (0) and USART2 (1).
  int line(std::size_t index) const { return lines_[index].get(); }
  pid_t id() const { return id_; }

  /// How it ended, with what it said; empty while it runs.
  std::string ended();

 private:
  std::string said() const;

  std::array<OwnedFd, kLines> lines_;
  OwnedFd log_;
  pid_t id_ = -1;
  std::optional<int> status_;
};

}  // namespace hoof::tools::qemu
