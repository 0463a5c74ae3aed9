#include "hal/socketcan/socketcan_bus.h"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <utility>

#include "hal/can_frame_check.h"
#include "hal/socketcan/kernel_frame.h"
#include "hal/socketcan/socketcan_batch.h"

namespace hoof::hal {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

// Not in Debian 12's <linux/can/error.h>; kernel 6.2 and later set it when data[6], data[7] are
// valid.
constexpr std::uint32_t kErrorCountsValid = 0x200;

std::int64_t to_ns(const timespec& time) {
  return time.tv_sec * kNsPerSecond + time.tv_nsec;
}

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return to_ns(now);
}

std::int64_t monotonic_stamp_ns(std::int64_t realtime_stamp_ns) {
  const std::int64_t monotonic_ns = clock_ns(CLOCK_MONOTONIC);
  if (realtime_stamp_ns == 0) return monotonic_ns;
  const std::int64_t age_ns = clock_ns(CLOCK_REALTIME) - realtime_stamp_ns;
  return monotonic_ns - std::max<std::int64_t>(0, age_ns);
}

canfd_frame to_kernel(const CanFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.len = frame.length;
  if (frame.bit_rate_switch) raw.flags |= CANFD_BRS;
  if (frame.error_state_indicator) raw.flags |= CANFD_ESI;
  if (!frame.remote) std::copy_n(frame.data.begin(), frame.length, raw.data);
  return raw;
}

CanFrame from_kernel(const canfd_frame& raw, bool fd) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = !fd && (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = fd;
  frame.bit_rate_switch = fd && (raw.flags & CANFD_BRS) != 0;
  frame.error_state_indicator = fd && (raw.flags & CANFD_ESI) != 0;
  const std::size_t room = fd ? CanFrame::kMaxFdLength : CanFrame::kMaxClassicLength;
  frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(raw.len, room));
  std::copy_n(raw.data, frame.length, frame.data.begin());
  return frame;
}

template <typename Value>
bool set_option(int fd, int level, int option, const Value& value) {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

SendResult meaning_of(int error_number) {
  switch (error_number) {
    case EAGAIN:
    case ENOBUFS:  // the interface's queue (ip link set can0 txqueuelen 1000) is full
      return SendResult::kFull;
    case EINVAL:
    case EMSGSIZE:
      return SendResult::kInvalid;
    default:
      return SendResult::kDown;
  }
}

}  // namespace

void KernelFrame::read_ancillary(msghdr& message) {
  realtime_stamp_ns = 0;
  has_drops = false;
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item; item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(item), sizeof stamp);
      realtime_stamp_ns = to_ns(stamp);
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&drops, CMSG_DATA(item), sizeof drops);
      has_drops = true;
    }
  }
}

SocketCanBus::SocketCanBus(SocketCanSettings settings) : settings_(std::move(settings)) {
  // A batch sleeps in the call that takes it; all else says with each call that it must not.
  const int blocking = settings_.batched ? 0 : SOCK_NONBLOCK;
  fd_ = socket(PF_CAN, SOCK_RAW | blocking | SOCK_CLOEXEC, CAN_RAW);
  if (fd_ < 0) {
    fail(
        "this kernel has no CAN (modprobe can-raw; in a virtual machine without it, run the "
        "command under tools/vcan/with-vcan)",
        errno);
  }
  try {
    configure();
  } catch (...) {
    close(fd_);
    throw;
  }
  if (settings_.batched) batch_ = std::make_unique<SocketCanBatch>();
}

SocketCanBus::~SocketCanBus() {
  close(fd_);
}

void SocketCanBus::fail(const std::string& what, int error_number) const {
  throw std::runtime_error(settings_.interface + ": " + what + ": " + std::strerror(error_number));
}

void SocketCanBus::configure() {
  ifreq request{};
  if (settings_.interface.empty() || settings_.interface.size() >= sizeof request.ifr_name) {
    fail("an interface name has 1 to 15 letters", EINVAL);
  }
  settings_.interface.copy(request.ifr_name, sizeof request.ifr_name - 1);
  if (ioctl(fd_, SIOCGIFINDEX, &request) != 0) {
    fail("no such CAN interface (ip link add dev " + settings_.interface +
             " type vcan makes a virtual one)",
         errno);
  }
  const int index = request.ifr_ifindex;
  if (ioctl(fd_, SIOCGIFFLAGS, &request) != 0) fail("its state cannot be read", errno);
  if ((request.ifr_flags & IFF_UP) == 0) {
    fail("the interface is down (ip link set " + settings_.interface + " up)", ENETDOWN);
  }
  if (settings_.fd) {
    if (ioctl(fd_, SIOCGIFMTU, &request) != 0) fail("its MTU cannot be read", errno);
    if (request.ifr_mtu < static_cast<int>(CANFD_MTU)) {
      fail("no CAN FD here (ip link set " + settings_.interface +
               " mtu 72 while it is down; a real interface needs `type can ... fd on`)",
           EPROTONOSUPPORT);
    }
    if (!set_option(fd_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1)) fail("CAN FD was refused", errno);
  }
  const can_err_mask_t all_errors = CAN_ERR_MASK;
  if (!set_option(fd_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, all_errors)) {
    fail("error frames were refused", errno);
  }
  if (!settings_.filters.empty()) {
    std::vector<can_filter> filters;
    for (const CanFilter& filter : settings_.filters) {
      // The format bit is part of both sides, so that a filter passes one format only.
      filters.push_back({filter.id | (filter.extended ? CAN_EFF_FLAG : 0U),
                         (filter.mask & CAN_EFF_MASK) | CAN_EFF_FLAG});
    }
    const auto bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
    if (setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) != 0) {
      fail("the acceptance filters were refused", errno);
    }
  }
  // Best effort: what was granted is visible in receive_buffer_bytes(), what it loses in dropped.
  if (!set_option(fd_, SOL_SOCKET, SO_RCVBUFFORCE, settings_.receive_buffer_bytes)) {
    set_option(fd_, SOL_SOCKET, SO_RCVBUF, settings_.receive_buffer_bytes);
  }
  if (settings_.batched) settings_.stamps = false;
  if (settings_.stamps && !set_option(fd_, SOL_SOCKET, SO_TIMESTAMPNS, 1)) {
    fail("time stamps were refused", errno);
  }
  if (!set_option(fd_, SOL_SOCKET, SO_RXQ_OVFL, 1)) fail("drop counts were refused", errno);

  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail(errno == ENODEV ? "this is no CAN interface" : "cannot listen on it", errno);
  }
}

SendResult SocketCanBus::send(const CanFrame& frame) {
  if (!can_exist(frame) || (frame.fd && !settings_.fd)) return SendResult::kInvalid;
  if (status_.bus_off) return SendResult::kBusOff;
  const canfd_frame raw = to_kernel(frame);
  const std::size_t bytes = frame.fd ? CANFD_MTU : CAN_MTU;
  if (batch_) {
    if (!batch_->put(raw, bytes)) {
      flush();
      if (!batch_->put(raw, bytes)) return SendResult::kFull;
    }
    ++status_.sent;
    return SendResult::kQueued;
  }
  ssize_t written = 0;
  do {
    written = write(fd_, &raw, bytes);
  } while (written < 0 && errno == EINTR);
  if (written < 0) return meaning_of(errno);
  ++status_.sent;
  return SendResult::kQueued;
}

SendResult SocketCanBus::flush() {
  const int error = batch_ ? batch_->flush(fd_) : 0;
  return error == 0 ? SendResult::kQueued : meaning_of(error);
}

bool SocketCanBus::next(KernelFrame& frame) {
  if (batch_) return batch_->next(fd_, frame);
  iovec part{&frame.raw, sizeof frame.raw};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  do {
    frame.length = recvmsg(fd_, &message, MSG_DONTWAIT);
  } while (frame.length < 0 && errno == EINTR);
  if (frame.exists()) frame.read_ancillary(message);
  return frame.exists();  // else nothing waits, or the interface went down
}

bool SocketCanBus::receive(CanFrame& frame) {
  KernelFrame raw;
  while (next(raw)) {
    if (take(raw, frame)) return true;
  }
  return false;
}

/// @return false where it tells of the controller, not of another node
bool SocketCanBus::take(const KernelFrame& raw, CanFrame& frame) {
  if (raw.has_drops) status_.dropped = raw.drops;
  if (!raw.exists()) return false;
  if ((raw.raw.can_id & CAN_ERR_FLAG) != 0) {
    take_error_frame(raw.raw.can_id & CAN_ERR_MASK, raw.raw.data);
    return false;
  }
  frame = from_kernel(raw.raw, raw.length == static_cast<ssize_t>(CANFD_MTU));
  if (settings_.stamps) frame.stamp_ns = monotonic_stamp_ns(raw.realtime_stamp_ns);
  ++status_.received;
  return true;
}

void SocketCanBus::take_error_frame(std::uint32_t error_class, const std::uint8_t* data) {
  ++status_.error_frames;
  if ((error_class & CAN_ERR_CRTL) != 0) {
    const std::uint8_t passive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
    const std::uint8_t healthier =
        CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_ACTIVE;
    if ((data[1] & passive) != 0) {
      status_.error_passive = true;
    } else if ((data[1] & healthier) != 0) {
      status_.error_passive = false;
    }
  }
  // Drivers of older kernels fill the counters without the flag, but only in these two classes.
  if ((error_class & (kErrorCountsValid | CAN_ERR_CRTL)) != 0) {
    status_.transmit_error_count = data[6];
    status_.receive_error_count = data[7];
  }
  if ((error_class & CAN_ERR_BUSOFF) != 0) status_.bus_off = true;
  if ((error_class & CAN_ERR_RESTARTED) != 0) {
    status_.bus_off = false;
    status_.error_passive = false;
  }
}

bool SocketCanBus::wait(std::int64_t timeout_ns) {
  if (batch_) {
    flush();
    return batch_->wait(fd_, timeout_ns);
  }
  const std::int64_t deadline_ns = clock_ns(CLOCK_MONOTONIC) + timeout_ns;
  while (true) {
    const std::int64_t left_ns = std::max<std::int64_t>(0, deadline_ns - clock_ns(CLOCK_MONOTONIC));
    const timespec timeout{left_ns / kNsPerSecond, left_ns % kNsPerSecond};
    pollfd entry{fd_, POLLIN, 0};
    const int ready = ppoll(&entry, 1, &timeout, nullptr);
    if (ready >= 0 || errno != EINTR) return ready > 0;
    if (left_ns == 0) return false;
  }
}

int SocketCanBus::receive_buffer_bytes() const {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes;
}

}  // namespace hoof::hal
