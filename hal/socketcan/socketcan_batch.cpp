#include "hal/socketcan/socketcan_batch.h"

#include <poll.h>
#include <sys/time.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace hoof::hal {
namespace {

/// The socket's own time-out counts the kernel's coarse ticks; shorter waits need the fine timer of
/// poll(), and one more call.
constexpr std::int64_t kCoarse_ns = 20'000'000;

}  // namespace

SocketCanBatch::SocketCanBatch() {
  for (std::size_t i = 0; i < kMost; ++i) {
    in_parts_[i] = {&frames_[i].raw, sizeof frames_[i].raw};
    in_messages_[i].msg_hdr.msg_iov = &in_parts_[i];
    in_messages_[i].msg_hdr.msg_iovlen = 1;
    in_messages_[i].msg_hdr.msg_control = control_[i].data();
    out_parts_[i] = {&out_[i], 0};
    out_messages_[i].msg_hdr.msg_iov = &out_parts_[i];
    out_messages_[i].msg_hdr.msg_iovlen = 1;
  }
}

bool SocketCanBatch::fill(int fd, int flags) {
  for (mmsghdr& message : in_messages_) message.msg_hdr.msg_controllen = control_[0].size();
  const int got = recvmmsg(fd, in_messages_.data(), kMost, flags, nullptr);
  first_ = 0;
  count_ = got > 0 ? static_cast<std::size_t>(got) : 0;
  drained_ = count_ > 0 && count_ < kMost;
  for (std::size_t i = 0; i < count_; ++i) {
    frames_[i].length = static_cast<ssize_t>(in_messages_[i].msg_len);
    frames_[i].read_ancillary(in_messages_[i].msg_hdr);
  }
  return count_ > 0;
}

bool SocketCanBatch::next(int fd, KernelFrame& frame) {
  if (first_ == count_) {
    if (drained_) {
      drained_ = false;
      return false;
    }
    if (!fill(fd, MSG_DONTWAIT)) return false;
  }
  frame = frames_[first_++];
  return true;
}

bool SocketCanBatch::wait(int fd, std::int64_t timeout_ns) {
  if (first_ < count_) return true;
  drained_ = false;
  if (timeout_ns < kCoarse_ns) {
    pollfd entry{fd, POLLIN, 0};
    const timespec timeout{0, static_cast<long>(std::max<std::int64_t>(0, timeout_ns))};
    return ppoll(&entry, 1, &timeout, nullptr) > 0 && fill(fd, MSG_DONTWAIT);
  }
  if (timeout_ns != timeout_ns_) {
    const timeval timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000 / 1000};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
    timeout_ns_ = timeout_ns;
  }
  return fill(fd, MSG_WAITFORONE);
}

bool SocketCanBatch::put(const canfd_frame& raw, std::size_t bytes) {
  if (waiting_ == kMost) return false;
  std::memcpy(&out_[waiting_], &raw, bytes);
  out_parts_[waiting_].iov_len = bytes;
  ++waiting_;
  return true;
}

int SocketCanBatch::flush(int fd) {
  std::size_t sent = 0;
  int error = 0;
  while (sent < waiting_ && error == 0) {
    const int taken = sendmmsg(fd, out_messages_.data() + sent,
                               static_cast<unsigned>(waiting_ - sent), MSG_DONTWAIT);
    if (taken > 0) {
      sent += static_cast<std::size_t>(taken);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  for (std::size_t i = sent; i < waiting_; ++i) {
    out_[i - sent] = out_[i];
    out_parts_[i - sent].iov_len = out_parts_[i].iov_len;
  }
  waiting_ -= sent;
  return error;
}

}  // namespace hoof::hal
