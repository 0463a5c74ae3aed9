// The host's end of a serial line that speaks SLCAN: what slcand is to an adapter (hal/slcan).
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "hal/can_bus.h"

namespace hoof::tools::qemu {

class SlcanClient final : public hal::CanBus {
 public:
  /// @param name for messages  @param fd a stream that does not block; must outlive this
  SlcanClient(std::string name, int fd) : name_(std::move(name)), fd_(fd) {}

  /// Asks until the other end answers, then opens the bus. @return false where it did not in time
  bool open(std::int64_t longest_ns);

  /// Keeps the frame until flush().
  hal::SendResult send(const hal::CanFrame& frame) override;
  bool receive(hal::CanFrame& frame) override;
  hal::BusStatus status() const override { return status_; }

  /// @return false where not all of it could be written
  bool flush();
  /// Until something came, or as long as that; takes what came.
  void wait(std::int64_t longest_ns);
  /// Frames that the other end has not taken yet.
  int untaken() const { return untaken_; }

  /// What went wrong on the line, for good; empty while all is well.
  const std::string& failure() const { return failure_; }

 private:
  void read();
  void take_line(const std::string& line, char end);
  bool await(const bool& what, std::int64_t give_up_ns);

  std::string name_;
  int fd_;
  std::string to_write_, heard_;
  std::deque<hal::CanFrame> frames_;
  int untaken_ = 0;
  bool alive_ = false, open_ = false;
  hal::BusStatus status_;
  std::string failure_;
};

/// Two lines keep no order among each other: what `then` keeps is written once the other end has
/// taken all that `first` kept, or never will. @return false where not all of it is written in time
bool flush_in_order(SlcanClient& first, SlcanClient& then, std::int64_t longest_ns);

}  // namespace hoof::tools::qemu
