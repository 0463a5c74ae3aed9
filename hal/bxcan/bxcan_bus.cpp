#include "hal/bxcan/bxcan_bus.h"

#include <bit>

#include "hal/can_frame_check.h"
#include "hal/interrupt_lock.h"

namespace hoof::hal::bxcan {
namespace {

/// Entering initialisation takes a few bit times from sleep, at most a frame (130 us) from a live
/// bus. At 168 MHz a look takes about 0.1 us.
constexpr std::uint32_t kInitialisationTries = 20'000;

/// The FIFO shows its next frame a few peripheral clocks after the last one was released.
constexpr std::uint32_t kReleaseTries = 50;

/// TTCM, ABOM, AWUM, NART, RFLM, TXFP off: no time stamps, no recovery of its own accord, repeat
/// until acknowledged, a full FIFO keeps its newest frame, mailboxes by identifier.
constexpr std::uint32_t kNormal = mcr::kDebugFreeze;
constexpr std::uint32_t kInitialisation = kNormal | mcr::kInitialisationRequest;

/// That of empty mailboxes comes and goes: see send().
constexpr std::uint32_t kInterrupts =
    ier::kFifo0Pending | ier::kFifo1Pending | ier::kBusOff | ier::kLastErrorCode | ier::kErrors;

constexpr std::uint32_t identifier_word(const CanFrame& frame) {
  const std::uint32_t remote = frame.remote ? identifier::kRemote : 0;
  if (!frame.extended) return (frame.id << identifier::kStandardShift) | remote;
  return (frame.id << identifier::kExtendedShift) | identifier::kExtended | remote;
}

// The peripheral's data registers hold byte 0 of four in their lowest bits, as memory does.
static_assert(std::endian::native == std::endian::little);

std::uint32_t four_bytes(const CanFrame& frame, std::size_t first) {
  std::uint32_t word = 0;
  __builtin_memcpy(&word, frame.data.data() + first, sizeof word);
  return word;
}

void unpack(std::uint32_t word, CanFrame& frame, std::size_t first) {
  __builtin_memcpy(frame.data.data() + first, &word, sizeof word);
}

/// All of it but the data beyond 8 bytes.
void write_frame(const ReceivedFrame& received, CanFrame& frame) {
  frame.extended = (received.identifier & identifier::kExtended) != 0;
  frame.remote = (received.identifier & identifier::kRemote) != 0;
  frame.id = received.identifier >>
             (frame.extended ? identifier::kExtendedShift : identifier::kStandardShift);
  const std::uint32_t code = received.length & 0xF;  // 9 to 15 also stand for 8 bytes
  frame.length = static_cast<std::uint8_t>(code > 8 ? 8 : code);
  frame.error = frame.fd = frame.bit_rate_switch = frame.error_state_indicator = false;
  unpack(frame.remote ? 0 : received.low, frame, 0);
  unpack(frame.remote ? 0 : received.high, frame, 4);
  frame.stamp_ns = received.stamp_ns;
}

}  // namespace

bool BxCanBus::start(std::uint32_t bit_timing) {
  state_ = State::kDown;
  registers_.IER.write(0);
  registers_.MCR.write(kInitialisation);  // also leaves sleep mode
  if (!wait_until(kInitialisationTries,
                  [this] { return registers_.MSR.has(msr::kInitialisation); })) {
    return false;
  }
  registers_.BTR.write(bit_timing);
  registers_.ESR.write(esr::kNoErrorYet);
  registers_.IER.write(kInterrupts);
  registers_.MCR.write(kNormal);
  state_ = State::kJoining;
  return true;
}

void BxCanBus::maintain(std::int64_t now_ns) {
  switch (state_) {
    case State::kDown:
      return;
    case State::kJoining:
      if (registers_.MSR.has(msr::kInitialisation) || registers_.ESR.has(esr::kBusOff)) return;
      joined_ns_ = now_ns;
      state_ = State::kOn;
      return;
    case State::kOn:
      if (registers_.ESR.has(esr::kBusOff)) return leave_bus(now_ns);
      if (now_ns - joined_ns_ >= kSteady_ns) back_off_ns_ = kFirstBackOff_ns;
      return;
    case State::kBackOff:
      if (now_ns < rejoin_ns_) return;
      registers_.MCR.write(kInitialisation);
      state_ = State::kResetting;
      return;
    case State::kResetting:
      if (!registers_.MSR.has(msr::kInitialisation)) return;
      registers_.MCR.write(kNormal);
      state_ = State::kJoining;
      return;
  }
}

void BxCanBus::leave_bus(std::int64_t now_ns) {
  registers_.TSR.write(tsr::kAbortAll);
  rejoin_ns_ = now_ns + back_off_ns_;
  back_off_ns_ = back_off_ns_ * 2 < kLongestBackOff_ns ? back_off_ns_ * 2 : kLongestBackOff_ns;
  state_ = State::kBackOff;
}

SendResult BxCanBus::send(const CanFrame& frame) {
  if (!can_exist(frame) || frame.fd) return SendResult::kInvalid;
  if (state_ == State::kDown) return SendResult::kDown;
  if (state_ != State::kOn || registers_.ESR.has(esr::kBusOff)) {
    return bus_off() ? SendResult::kBusOff : SendResult::kDown;
  }
  const std::uint32_t identifier = identifier_word(frame);
  const std::uint32_t status = take_completed();
  const std::size_t chosen = choose_mailbox(status, identifier);
  if (chosen == kMailboxes) {
    // Only who waits for room wants to know when a frame has left: else each would wake the core.
    registers_.IER.set(ier::kMailboxEmpty);
    return SendResult::kFull;
  }
  Mailbox& mailbox = registers_.transmit[chosen];
  mailbox.length.write(frame.length);
  mailbox.low.write(four_bytes(frame, 0));
  mailbox.high.write(four_bytes(frame, 4));
  mailbox.identifier.write(identifier | identifier::kTransmit);
  return SendResult::kQueued;
}

/// Counts what has left since the last call; a mailbox forgets it with its next frame.
/// @return TSR as it was
std::uint32_t BxCanBus::take_completed() {
  const std::uint32_t status = registers_.TSR.read();
  const std::uint32_t completed = status & tsr::kAllCompleted;
  if (completed == 0) return status;
  sent_ += tsr::transmissions_ok(status);
  registers_.TSR.write(completed);
  return status;
}

/// RM0090 rev. 19, 32.7.1 (abort): a mailbox that is pending or scheduled is empty at once, one
/// that is being sent when its frame has ended.
void BxCanBus::withdraw(std::uint32_t id) {
  const std::uint32_t status = registers_.TSR.read();
  if ((status & tsr::kAllEmpty) == tsr::kAllEmpty) return;
  const std::uint32_t identifier = id << identifier::kStandardShift;
  std::uint32_t aborts = 0;
  for (std::size_t i = 0; i < kMailboxes; ++i) {
    const std::uint32_t held = registers_.transmit[i].identifier.read() & ~identifier::kTransmit;
    if ((status & tsr::empty(i)) == 0 && held == identifier) aborts |= tsr::abort(i);
  }
  if (aborts != 0) registers_.TSR.write(aborts);
}

/// The first empty mailbox above all that hold the same identifier.
std::size_t BxCanBus::choose_mailbox(std::uint32_t status, std::uint32_t identifier) const {
  std::size_t chosen = kMailboxes;
  for (std::size_t i = kMailboxes; i-- > 0;) {
    if ((status & tsr::empty(i)) != 0) {
      chosen = i;
    } else if ((registers_.transmit[i].identifier.read() & ~identifier::kTransmit) == identifier) {
      return chosen;
    }
  }
  return chosen;
}

bool BxCanBus::receive(CanFrame& frame) {
  const ReceivedFrame* received = queue_.oldest();
  if (received == nullptr) return false;
  write_frame(*received, frame);
  queue_.drop();
  ++received_;
  return true;
}

bool BxCanBus::bus_off() const {
  if (state_ == State::kDown) return false;
  return state_ == State::kBackOff || state_ == State::kResetting ||
         registers_.ESR.has(esr::kBusOff);
}

BusStatus BxCanBus::status() const {
  BusStatus status;
  if (state_ != State::kDown) {
    const std::uint32_t errors = registers_.ESR.read();
    status.bus_off = bus_off();
    status.error_passive = (errors & esr::kErrorPassive) != 0;
    status.transmit_error_count = esr::transmit_errors(errors);
    status.receive_error_count = esr::receive_errors(errors);
  }
  status.received = received_;
  status.sent = sent_ + (state_ == State::kDown ? 0 : tsr::transmissions_ok(registers_.TSR.read()));
  const InterruptLock lock;  // two words each
  status.dropped = dropped_;
  status.error_frames = error_frames_;
  return status;
}

void BxCanBus::on_receive_interrupt(std::size_t fifo, std::int64_t now_ns) {
  Register& fifo_status = registers_.RFR[fifo];
  std::uint32_t status = fifo_status.read();
  for (std::uint32_t i = 0; i < kFifoDepth && (status & rfr::kPending) != 0; ++i) {
    take_frame(fifo, now_ns);
    fifo_status.write(rfr::kRelease);
    wait_until(kReleaseTries, [&] {
      status = fifo_status.read();
      return (status & rfr::kRelease) == 0;
    });
  }
  if ((status & rfr::kOverrun) != 0) {
    ++dropped_;  // one at least; the peripheral does not count them
    fifo_status.write(rfr::kOverrun);
  }
}

void BxCanBus::take_frame(std::size_t fifo, std::int64_t now_ns) {
  const Mailbox& mailbox = registers_.receive[fifo];
  const ReceivedFrame frame{mailbox.identifier.read(), mailbox.length.read(), mailbox.low.read(),
                            mailbox.high.read(), now_ns};
  if (!queue_.put(frame, fifo == kUrgentFifo)) ++dropped_;
}

/// Once: what has left is counted with the next frame, and until then would interrupt again.
void BxCanBus::on_transmit_interrupt() {
  registers_.IER.clear(ier::kMailboxEmpty);
}

void BxCanBus::on_status_interrupt() {
  const std::uint32_t code = registers_.ESR.read() & esr::kLastErrorCode;
  if (code != 0 && code != esr::kNoErrorYet) {
    ++error_frames_;
    registers_.ESR.write(esr::kNoErrorYet);
  }
  registers_.MSR.write(msr::kErrorInterrupt);
}

}  // namespace hoof::hal::bxcan
