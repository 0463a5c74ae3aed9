// Several frames per call of the kernel. Private to this folder.
#pragma once

#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/socketcan/kernel_frame.h"

namespace hoof::hal {

class SocketCanBatch {
 public:
  static constexpr std::size_t kMost = 32;

  SocketCanBatch();
  SocketCanBatch(const SocketCanBatch&) = delete;
  SocketCanBatch& operator=(const SocketCanBatch&) = delete;

  /// The oldest frame; asks the kernel where none is left here. After the last one of a batch that
  /// took all there was it says once that there is none, without asking.
  bool next(int fd, KernelFrame& frame);

  /// Sleeps for a frame at most until the time is over; the socket must not be non-blocking.
  bool wait(int fd, std::int64_t timeout_ns);

  /// @return false where no room is left: flush() first
  bool put(const canfd_frame& raw, std::size_t bytes);

  /// @return errno of the kernel, which took no more; 0 when all of it is on its way
  int flush(int fd);

 private:
  bool fill(int fd, int flags);

  std::array<KernelFrame, kMost> frames_;
  std::array<iovec, kMost> in_parts_{};
  std::array<mmsghdr, kMost> in_messages_{};
  alignas(cmsghdr) std::array<std::array<char, 64>, kMost> control_{};
  std::size_t first_ = 0, count_ = 0;  // of frames_
  bool drained_ = false;               // the last batch was not full, and its end was not told yet
  std::int64_t timeout_ns_ = -1;       // that the socket has been given

  std::array<canfd_frame, kMost> out_;
  std::array<iovec, kMost> out_parts_{};
  std::array<mmsghdr, kMost> out_messages_{};
  std::size_t waiting_ = 0;
};

}  // namespace hoof::hal
