// A CAN interface of Linux (can0, vcan0) as a CanBus. Needs no CAN library: raw sockets only.
//
// Time stamps. The kernel stamps each frame when it arrives (SO_TIMESTAMPNS, CLOCK_REALTIME).
// receive() turns the stamp into the time of MonotonicClock by the frame's age: now_monotonic -
// (now_realtime - stamp). A step of the calendar clock between arrival and reading shifts the
// stamps of the frames that wait at that moment, and no others.
//
// Errors. Error frames of the controller update status() and are not handed to the user. Transmit
// and receive error counts are those of the last error frame that carried them. After bus-off,
// send() refuses with kBusOff until the kernel reports a restart (`ip link set can0 type can
// restart-ms 100`).
//
// Batches. With settings.batched a call of the kernel takes or gives several frames, for two
// programs that exchange a handful of frames and wait for each other: send() only keeps the frame
// until flush() or wait(), received frames bear no time stamp, and after the last frame of a batch
// receive() says once that nothing waits without asking again.
//
// Losses. A reader that sleeps loses frames once SO_RCVBUF is full; the kernel counts them
// (SO_RXQ_OVFL) and status().dropped shows them from the next received frame on.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/can_bus.h"
#include "hal/can_filter.h"

namespace hoof::hal {

struct SocketCanSettings {
  std::string interface = "vcan0";
  std::vector<CanFilter> filters;  // empty: everything
  bool fd = false;                 // also CAN FD frames; needs an interface with an MTU of 72
  bool stamps = true;              // false: received frames bear stamp 0, for two calls less each
  bool batched = false;            // several frames a system call, no stamps; see above
  /// Asked of the kernel. 4 MiB hold about 5,000 waiting frames, as one costs about 800 bytes of
  /// kernel memory; ordinary users get at most net.core.rmem_max, which is reported by
  /// receive_buffer_bytes().
  int receive_buffer_bytes = 4 * 1024 * 1024;
};

struct KernelFrame;
class SocketCanBatch;

class SocketCanBus final : public CanBus {
 public:
  /// @throws std::runtime_error naming the interface, the reason and what to do about it
  explicit SocketCanBus(SocketCanSettings settings);
  ~SocketCanBus();
  SocketCanBus(const SocketCanBus&) = delete;
  SocketCanBus& operator=(const SocketCanBus&) = delete;

  /// `sent` counts frames that the kernel accepted for transmission.
  SendResult send(const CanFrame& frame) override;
  bool receive(CanFrame& frame) override;
  /// Reads no socket: error frames are seen while receiving.
  BusStatus status() const override { return status_; }

  /// Gives the kernel what send() kept. Nothing to do where the bus is not batched.
  /// @return kQueued when all of it is on its way; else the kernel's reason, and the rest is kept
  SendResult flush();

  /// Sleeps until a frame waits or the time is over.
  /// @return true when something waits; it may be an error frame, for which receive() gives false.
  bool wait(std::int64_t timeout_ns);

  /// For poll() and epoll; do not read from it.
  int fd() const { return fd_; }

  int receive_buffer_bytes() const;  // as granted, in kernel accounting (twice the payload room)

 private:
  void configure();
  [[noreturn]] void fail(const std::string& what, int error_number) const;
  bool next(KernelFrame& raw);
  bool take(const KernelFrame& raw, CanFrame& frame);
  void take_error_frame(std::uint32_t error_class, const std::uint8_t* data);

  SocketCanSettings settings_;
  int fd_ = -1;
  BusStatus status_;
  std::unique_ptr<SocketCanBatch> batch_;  // null where the bus is not batched
};

}  // namespace hoof::hal
