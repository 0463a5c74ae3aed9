#include "tools/emulator/bxcan.h"

#include <algorithm>

namespace hoof::tools::emulator {
namespace {

constexpr std::uint32_t kInitialise = 1u << 0, kSleep = 1u << 1, kRecoverByItself = 1u << 6,
                        kDebugFreeze = 1u << 16;
constexpr std::uint32_t kCompleted = 1u << 0, kTransmitted = 1u << 1;
constexpr std::uint32_t kRequest = 1u << 0, kRemote = 1u << 1, kExtended = 1u << 2;
constexpr std::uint32_t kStuffError = 1;

// IER
constexpr std::uint32_t kEmptyInterrupt = 1u << 0, kWarningInterrupt = 1u << 8,
                        kPassiveInterrupt = 1u << 9, kOffInterrupt = 1u << 10,
                        kCodeInterrupt = 1u << 11, kErrorInterrupt = 1u << 15;

constexpr Cycles kBit = kCyclesPerMicrosecond;
constexpr Cycles kElevenBits = 11 * kBit;

std::uint32_t identifier_of(const hal::CanFrame& frame) {
  return frame.id << (frame.extended ? 3 : 21) | (frame.extended ? kExtended : 0) |
         (frame.remote ? kRemote : 0);
}

}  // namespace

BxCan::BxCan(int number, const BoardTime& time, Nvic& nvic, CanFilters& filters,
             int first_interrupt, std::function<std::uint32_t()> clock_MHz)
    : number_(number),
      time_(time),
      nvic_(nvic),
      filters_(filters),
      first_interrupt_(exception::kFirstInterrupt + first_interrupt),
      clock_MHz_(std::move(clock_MHz)) {}

void BxCan::reset() {
  control_ = kSleep | kDebugFreeze;
  interrupts_ = 0;
  timing_ = 0x0123'0000;
  last_error_ = 0;
  initialising_ = error_flag_ = recovering_ = false;
  sleeping_ = true;
  mailboxes_ = {};
  fifos_ = {};
  former_ = wire_->status();
  if (number_ == 1) filters_.reset();
  update_lines();
}

void BxCan::connect(std::unique_ptr<CanWire> wire) {
  complete_sent();
  wire_ = std::move(wire);
  for (Transmit& m : mailboxes_) m.offered = false;
}

bool BxCan::on_bus() const {
  return !sleeping_ && !initialising_ && !recovering_;
}

/// Joining takes eleven recessive bits, after bus-off 128 times as many.
void BxCan::leave_initialisation_if_due() {
  if (initialising_ && (control_ & kInitialise) == 0 && time_.now >= joins_) {
    require_bit_rate();
    initialising_ = false;
    recovering_ = wire_->status().bus_off;
    joins_ = time_.now + 128 * kElevenBits;
  }
  if (recovering_ && time_.now >= joins_) {
    recovering_ = false;
    wire_->join_again();
    former_ = wire_->status();
  }
}

void BxCan::require_bit_rate() const {
  const std::uint32_t quanta = 3 + (timing_ >> 16 & 0xF) + (timing_ >> 20 & 7);
  const std::uint32_t divider = (timing_ & 0x3FF) + 1;
  if (clock_MHz_() != quanta * divider) {
    throw EmulatorError(std::string(name()) + ": BTR " + hex(timing_) + " at " +
                        std::to_string(clock_MHz_()) + " MHz is not 1 Mbit/s");
  }
  if ((timing_ >> 30) != 0) throw EmulatorError("bxCAN: loop-back and silent mode have no model");
}

bool BxCan::advance(bool overrun) {
  leave_initialisation_if_due();
  complete_sent();
  const bool waiting = receive(overrun);
  watch_errors();
  offer_pending();
  update_lines();
  return waiting;
}

hal::CanFrame BxCan::frame_in(const Transmit& mailbox) {
  hal::CanFrame frame;
  frame.extended = (mailbox.identifier & kExtended) != 0;
  frame.remote = (mailbox.identifier & kRemote) != 0;
  frame.id = mailbox.identifier >> (frame.extended ? 3 : 21);
  frame.length = std::uint8_t(std::min<std::uint32_t>(mailbox.length & 0xF, 8));
  if (frame.remote) return frame;
  for (std::size_t i = 0; i < frame.length; ++i) {
    frame.data[i] = std::uint8_t((i < 4 ? mailbox.low : mailbox.high) >> (8 * (i % 4)));
  }
  return frame;
}

void BxCan::offer_pending() {
  if (!on_bus() || wire_->status().bus_off) return;
  for (Transmit& m : mailboxes_) {
    if (!m.pending || m.offered) continue;
    m.offered = wire_->offer(frame_in(m));
  }
}

void BxCan::complete_sent() {
  for (const hal::CanFrame& frame : wire_->take_sent()) {
    for (Transmit& m : mailboxes_) {
      if (!m.pending || !m.offered || !(frame_in(m) == frame)) {
        continue;
      }
      m.pending = m.offered = false;
      m.identifier &= ~kRequest;
      m.result = kCompleted | kTransmitted;
      break;
    }
  }
}

bool BxCan::receive(bool overrun) {
  for (;;) {
    // A FIFO that is full may be the one of the next frame; it is not known before.
    const bool room = fifos_[0].frames.size() < kFifoDepth && fifos_[1].frames.size() < kFifoDepth;
    if (on_bus() && !room && !overrun) return true;
    hal::CanFrame frame;
    if (!wire_->take(frame)) return false;
    if (!on_bus() || frame.fd || frame.error) continue;
    const auto match = filters_.match(std::size_t(number_ - 1), identifier_of(frame));
    if (match) put(frame, *match);
  }
}

void BxCan::put(const hal::CanFrame& frame, const CanFilters::Match& match) {
  Received r;
  r.identifier = identifier_of(frame);
  r.length = frame.length | match.index << 8;
  for (std::size_t i = 0; i < frame.length && i < 8; ++i) {
    (i < 4 ? r.low : r.high) |= std::uint32_t{frame.data[i]} << (8 * (i % 4));
  }
  Fifo& fifo = fifos_[match.fifo];
  if (fifo.frames.size() == kFifoDepth) {
    fifo.overrun = true;  // not locked: the newest takes the place of the last
    fifo.frames.back() = r;
  } else {
    fifo.frames.push_back(r);
  }
}

/// Error counters are the wire's; each destroyed frame is told as a stuff error.
void BxCan::watch_errors() {
  const hal::BusStatus now = wire_->status();
  const auto warns = [](const hal::BusStatus& s) {
    return s.transmit_error_count >= 96 || s.receive_error_count >= 96;
  };
  std::uint32_t risen = 0;
  if (now.error_frames != former_.error_frames) {
    last_error_ = kStuffError;
    risen |= kCodeInterrupt;
  }
  if (now.bus_off && !former_.bus_off) {
    risen |= kOffInterrupt;
    for (Transmit& m : mailboxes_) m.offered = false;
    if ((control_ & kRecoverByItself) != 0) throw EmulatorError("bxCAN: ABOM has no model");
  }
  if (now.error_passive && !former_.error_passive) risen |= kPassiveInterrupt;
  if (warns(now) && !warns(former_)) risen |= kWarningInterrupt;
  if ((risen & interrupts_) != 0) error_flag_ = true;
  former_ = now;
}

void BxCan::update_lines() {
  const bool completed = std::any_of(mailboxes_.begin(), mailboxes_.end(), [](const Transmit& m) {
    return (m.result & kCompleted) != 0;
  });
  nvic_.set_line(first_interrupt_, completed && (interrupts_ & kEmptyInterrupt) != 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t enabled = interrupts_ >> (1 + 3 * i);
    const Fifo& f = fifos_[i];
    const bool high = ((enabled & 1) != 0 && !f.frames.empty()) ||
                      ((enabled & 2) != 0 && f.frames.size() == kFifoDepth) ||
                      ((enabled & 4) != 0 && f.overrun);
    nvic_.set_line(first_interrupt_ + 1 + int(i), high);
  }
  nvic_.set_line(first_interrupt_ + 3, error_flag_ && (interrupts_ & kErrorInterrupt) != 0);
}

}  // namespace hoof::tools::emulator
