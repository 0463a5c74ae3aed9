// The firmware's end of a recorded bus: hands it the recorded frames, and holds what it sends until
// the recording says what went over the wire.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "hal/can_bus.h"

namespace hoof::tools {

/// Refuses frames while all mailboxes wait, as the recorded bus did: the firmware counts refusals
/// and sends some of them again.
class ReplayBus final : public hal::CanBus {
 public:
  struct Waiting {
    hal::CanFrame frame;
    std::int64_t sent_ns = 0;
  };

  explicit ReplayBus(int mailboxes) : mailboxes_(mailboxes) {}

  /// Time of the sends that follow.
  void set_time(std::int64_t now_ns) { now_ns_ = now_ns; }
  /// A frame of another node has arrived.
  void arrive(const hal::CanFrame& frame) { received_.push_back(frame); }

  /// What the firmware would put on a wire that is free at `start_ns`: the waiting frame that wins
  /// arbitration, equal ones in the order of sending. Null where nothing waits.
  const Waiting* next(std::int64_t start_ns) const;
  /// Of this identifier, whether or not it is its turn.
  const Waiting* find(std::uint32_t id) const;
  void remove(const Waiting& waiting);
  const std::vector<Waiting>& waiting() const { return waiting_; }

  hal::SendResult send(const hal::CanFrame& frame) override;
  bool receive(hal::CanFrame& frame) override;
  hal::BusStatus status() const override { return status_; }

 private:
  int mailboxes_;
  std::int64_t now_ns_ = 0;
  std::deque<hal::CanFrame> received_;
  std::vector<Waiting> waiting_;  // in the order of sending
  hal::BusStatus status_;
};

}  // namespace hoof::tools
