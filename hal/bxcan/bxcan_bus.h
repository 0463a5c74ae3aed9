// A CAN bus through the bxCAN peripheral of an STM32.
//
// Sending. Three mailboxes; the peripheral sends the smallest identifier first (MCR.TXFP = 0) and,
// of equal ones, the lower mailbox. So that equal identifiers leave in the order of sending, a
// frame never goes into a mailbox below one that holds its identifier; rather, the bus is full.
// From then on, and only then, the next frame that leaves interrupts.
//
// Receiving. FIFO 0 is for what is urgent (the e-stop), FIFO 1 for the rest; the interrupts empty
// both into one queue of 32 frames, whose last places are for FIFO 0.
//
// Bus-off. The peripheral's own recovery (ABOM) would be back after 128 idle sequences, about a
// millisecond, and a node with a broken transceiver would disturb the bus for ever. Here it waits
// 100 ms before it joins again, twice as long each time up to 3.2 s, and starts at 100 ms again
// only after 10 s on the bus. Frames that waited are dropped: they would be old news.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/bxcan/registers.h"
#include "hal/can_bus.h"
#include "hal/receive_queue.h"

namespace hoof::hal::bxcan {

/// A frame as the peripheral holds it, with its arrival: a quarter of a CanFrame.
struct ReceivedFrame {
  std::uint32_t identifier = 0;
  std::uint32_t length = 0;
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::int64_t stamp_ns = 0;
};

class BxCanBus final : public CanBus {
 public:
  using Queue = ReceiveQueue<ReceivedFrame, 32, 3>;
  static constexpr std::size_t kUrgentFifo = 0;
  static constexpr std::size_t kOrdinaryFifo = 1;
  static constexpr std::int64_t kFirstBackOff_ns = 100'000'000;
  static constexpr std::int64_t kLongestBackOff_ns = 3'200'000'000;
  static constexpr std::int64_t kSteady_ns = 10'000'000'000;

  /// Down until start(). The peripheral's clock must run before that.
  explicit BxCanBus(Registers& registers) : registers_(registers) {}

  /// Configures the peripheral and begins to join the bus, which maintain() completes.
  /// @param bit_timing BTR, for normal mode
  /// @return false when no such peripheral answers: the bus then stays down
  bool start(std::uint32_t bit_timing);

  /// From the main loop, at least every few milliseconds: joining, bus-off and back-off.
  void maintain(std::int64_t now_ns);

  SendResult send(const CanFrame& frame) override;
  void withdraw(std::uint32_t id) override;
  bool receive(CanFrame& frame) override;
  BusStatus status() const override;
  bool bus_off() const override;
  bool frame_waiting() const { return !queue_.empty(); }

  // The peripheral's interrupts, of one priority: none of them interrupts another.
  void on_receive_interrupt(std::size_t fifo, std::int64_t now_ns);
  void on_transmit_interrupt();
  void on_status_interrupt();

 private:
  enum class State : std::uint8_t {
    kDown,     // not started, or no such peripheral
    kJoining,  // waits for eleven recessive bits, after bus-off for 128 times as many
    kOn,
    kBackOff,    // bus-off, waiting
    kResetting,  // bus-off is over; the peripheral is asked to forget it
  };

  /// kMailboxes when there is none.
  std::size_t choose_mailbox(std::uint32_t status, std::uint32_t identifier) const;
  std::uint32_t take_completed();
  void leave_bus(std::int64_t now_ns);
  void take_frame(std::size_t fifo, std::int64_t now_ns);

  Registers& registers_;
  Queue queue_;
  State state_ = State::kDown;
  std::int64_t joined_ns_ = 0;
  std::int64_t rejoin_ns_ = 0;
  std::int64_t back_off_ns_ = kFirstBackOff_ns;
  std::uint64_t received_ = 0;  // by the main loop, and so the next
  std::uint64_t sent_ = 0;      // but for what TSR still tells

  // By the interrupts.
  std::uint64_t dropped_ = 0;
  std::uint64_t error_frames_ = 0;
};

}  // namespace hoof::hal::bxcan
