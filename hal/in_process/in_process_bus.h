// The wire, in one process and in simulated time: arbitration by identifier, exact frame times, and
// nothing random. Same sends at the same times, same frames at the same times.
//
// Time. The bus moves only in advance_to(t). A node sends at the bus's present time; every frame
// that is pending at the instant the wire is free takes part in the arbitration of that instant,
// also those sent at that very instant, so a frame starts only once time moves past it. Frames are
// delivered at the end of their EOF field (their stamp); the wire is free again three bits
// (intermission) later.
//
//     bus.advance_to(t);            // delivers all frames that ended up to t
//     port.receive(frame) ...       // nodes react
//     port.send(reply);             // pending from t on
//     bus.next_event_ns()           // when the next frame would end
//
// Mailboxes. Each node has a few, the lowest arbitration field goes first (as bxCAN with TXFP = 0),
// equal ones in the order of sending.
//
// Acknowledgement is taken for granted: the wire behaves as if a logger always listened.
//
// Two nodes that send the same identifier at once. Equal frames overlay and both count as sent.
// Otherwise the node that sends the recessive bit at the first difference sees a bit error:
//   - error-active (transmit errors < 128): its error flag destroys the attempt of both; both count
//   8
//     transmit errors, each other node one receive error, and both try again after the error frame;
//   - error-passive: its flag is invisible; it alone counts 8 and tries again later, the other
//   frame
//     goes through. A counter above 255 takes the node off the bus.
// (ISO 11898-1:2015, 12.1.4; more than two at once are handled pairwise against the most dominant.)
// The 8 bits for which an error-passive sender waits before its next frame are not modelled.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hal/can_bus.h"
#include "hal/can_filter.h"
#include "hal/can_timing.h"
#include "hal/in_process/load_meter.h"

namespace hoof::hal {

class InProcessBus;

struct InProcessBusSettings {
  std::string name = "bus";
  BitRates bit_rates;      // 1 Mbit/s; FD data phase 5 Mbit/s
  int mailboxes = 3;       // per node, 1..8; bxCAN has 3
  int receive_queue = 64;  // frames per node; more are lost and counted
  bool fd = false;         // a classic bus refuses FD frames

  /// @throws std::invalid_argument naming the first broken rule: name, value, unit, bound.
  void validate() const;
};

/// One node's connection. Lives as long as its bus, at a fixed address.
class InProcessPort final : public CanBus {
 public:
  SendResult send(const CanFrame& frame) override;
  void withdraw(std::uint32_t id) override;
  bool receive(CanFrame& frame) override;
  BusStatus status() const override {
    BusStatus status = status_;
    status.free = static_cast<std::uint8_t>(free_mailboxes());
    return status;
  }

  /// Frames that no filter accepts never reach the queue. An empty list accepts everything.
  void set_filters(std::vector<CanFilter> filters) { filters_ = std::move(filters); }

  /// Takes the node off the bus (its waiting frames are lost, nothing is received; a frame already
  /// on the wire still ends) or brings it back with its error counters at zero. A node that its own
  /// errors took off the bus also stays off until it is brought back here.
  void set_bus_off(bool off);

  /// Called for each frame of this node that has left it, when it has. May not send.
  void on_sent(std::function<void(const CanFrame&)> told) { told_of_sent_ = std::move(told); }

  const std::string& name() const { return name_; }
  int index() const { return index_; }  // in the order of attach(), from 0
  int pending() const { return pending_count_; }
  int free_mailboxes() const { return static_cast<int>(mailboxes_.size()) - pending_count_; }

 private:
  friend class InProcessBus;

  struct Mailbox {
    bool used = false;
    bool on_wire = false;
    std::uint32_t key = 0;    // arbitration field
    std::uint64_t order = 0;  // of sending
    FrameBits bits;
    CanFrame frame;
  };

  InProcessPort(InProcessBus& bus, std::string name, int index);
  bool accepts(const CanFrame& frame) const;
  void deliver(const CanFrame& frame);
  void finish_sending();
  void count_transmit_error();
  void count_receive_error();
  void update_error_state();
  void leave_bus();
  void give_up(Mailbox& mailbox);
  Mailbox* best();

  InProcessBus& bus_;
  std::string name_;
  int index_;
  std::vector<Mailbox> mailboxes_;
  int pending_count_ = 0;
  std::vector<CanFrame> queue_;  // ring
  std::size_t queue_head_ = 0;
  std::size_t queue_size_ = 0;
  std::vector<CanFilter> filters_;
  std::function<void(const CanFrame&)> told_of_sent_;
  BusStatus status_;
  int transmit_errors_ = 0;  // may pass 255 on the way to bus-off
  int receive_errors_ = 0;
};

/// A frame that went over the wire.
struct WireRecord {
  const CanFrame& frame;  // stamp_ns = end of its EOF field
  int sender;             // port index; the first one when equal frames overlaid
  std::int64_t start_ns;  // start of SOF
  std::int64_t end_ns;    // end of EOF, without intermission
};

class InProcessBus {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  using Observer = std::function<void(const WireRecord&)>;

  /// @param observer called once for every frame that ends, in order, before nodes can take it; it
  /// may
  ///        send (the frame is pending from that instant on) but must not call advance_to().
  /// @throws std::invalid_argument for impossible settings
  explicit InProcessBus(InProcessBusSettings settings, Observer observer = {});
  InProcessBus(const InProcessBus&) = delete;
  InProcessBus& operator=(const InProcessBus&) = delete;

  /// Adds a node. The reference stays valid as long as the bus.
  InProcessPort& attach(std::string name);

  /// Moves time to `t_ns` (not before now_ns()); frames ending up to and at `t_ns` are delivered.
  void advance_to(std::int64_t t_ns);

  std::int64_t now_ns() const { return now_ns_; }

  /// When the next frame or error frame ends if nobody sends before; kNever when nothing is
  /// pending.
  std::int64_t next_event_ns() const;

  /// @return true when nothing is pending, on the wire or in the intermission.
  bool idle() const;

  /// Share of time the wire was occupied, intermission and error frames included.
  const LoadMeter& load() const { return load_; }
  double mean_load_ratio() const { return load_.mean_ratio(now_ns_); }

  std::uint64_t frames() const { return frames_; }
  std::uint64_t error_frames() const { return error_frames_; }
  /// Frames of one identifier that went over the wire.
  std::uint64_t frames_of(std::uint32_t id, bool extended = false) const;

  const InProcessBusSettings& settings() const { return settings_; }

 private:
  friend class InProcessPort;

  /// What happens on the wire next, or now.
  struct Transmission {
    InProcessPort* sender = nullptr;  // none: nothing is pending
    InProcessPort::Mailbox* mailbox = nullptr;
    bool contested = false;  // others send the same arbitration field at the same time
    bool destroyed = false;  // ends as an error frame
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;   // last bit of EOF or of the error delimiter
    std::int64_t free_ns = 0;  // the wire is free again
  };

  Transmission plan() const;
  void settle_contest(Transmission& next, int& bits_until_error) const;
  template <typename Visit>
  void for_each_rival(const Transmission& transmission, Visit&& visit) const;
  void start(const Transmission& next);
  void finish();
  void finish_frame(const Transmission& done);
  void finish_error();
  void count(const CanFrame& frame);

  InProcessBusSettings settings_;
  Observer observer_;
  std::vector<std::unique_ptr<InProcessPort>> ports_;
  Transmission on_wire_;
  std::int64_t intermission_ns_;
  std::int64_t now_ns_ = 0;
  std::int64_t free_at_ns_ = 0;
  int pending_total_ = 0;
  std::uint64_t next_order_ = 0;
  std::uint64_t frames_ = 0;
  std::uint64_t error_frames_ = 0;
  LoadMeter load_;
  std::vector<std::uint64_t> standard_counts_;  // by identifier
  std::map<std::uint32_t, std::uint64_t> extended_counts_;
};

}  // namespace hoof::hal
