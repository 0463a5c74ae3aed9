// A frame and what the kernel tells beside it. Private to this folder.
#pragma once

#include <linux/can.h>
#include <sys/socket.h>
#include <sys/types.h>

#include <cstdint>

namespace hoof::hal {

struct KernelFrame {
  canfd_frame raw{};
  ssize_t length = 0;                  // CAN_MTU or CANFD_MTU; anything else is no frame
  std::int64_t realtime_stamp_ns = 0;  // 0: none
  bool has_drops = false;
  std::uint32_t drops = 0;  // since the socket was opened

  bool exists() const {
    return length == static_cast<ssize_t>(CAN_MTU) || length == static_cast<ssize_t>(CANFD_MTU);
  }

  /// Takes time stamp and drop count out of the control part of a received message.
  void read_ancillary(msghdr& message);
};

}  // namespace hoof::hal
